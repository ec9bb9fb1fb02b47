// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "map.hpp"

namespace iib_localization {

//! As cv::iib::buildMap does, in memory.
Map makeMap(const std::string& model, const cv::iib::ImageReader& images, const cv::iib::MapOptions& options,
        const cv::iib::MappingReport& report);

}  // namespace iib_localization
