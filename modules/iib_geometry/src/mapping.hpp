// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "map.hpp"

namespace iib_localization {

/** Makes a map of a COLMAP model, as Python's opencv_iib.localization does, but for the adjustment of all points together.
@param photographs folder that the names of the model's images are relative to.
@throws cv::Exception for a model that is damaged or not that of the photographs. */
Map buildMap(
        const std::string& model, const std::string& photographs, const cv::iib::Localizer::Report& report);

}  // namespace iib_localization
