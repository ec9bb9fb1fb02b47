// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "model.hpp"

namespace iib_localization {

//! A map as Python's opencv_iib.localization writes it; see doc/maps.md.
struct Map
{
    Model model;                   //!< each keypoint of its images sees a point
    std::map<int, cv::Mat> codes;  //!< of each image, by its id: a row a keypoint, the strongest first
    int points = 2000;             //!< keypoints that are looked for in an image
};

//! @throws cv::Exception for what is no map, or a damaged one.
Map readMap(const std::string& folder);
}  // namespace iib_localization
