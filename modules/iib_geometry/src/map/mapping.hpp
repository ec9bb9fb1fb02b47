// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "map.hpp"

namespace cv::iib {

//! As buildMap, in memory.
Map makeMap(const std::string& model, const ImageReader& images, const MapOptions& options,
        const MappingReport& report);

}  // namespace cv::iib
