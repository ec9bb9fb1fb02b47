// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "views.hpp"

namespace iib_tools {

/** Reads pairs of images with cameras and poses in the format of SuperGlue's `match_pairs.py`. Each line has:
- the paths of two images below `folder`;
- the clockwise rotation at which each was taken, in quarter turns;
- both camera matrices (nine numbers a matrix, row by row) and the pose from the first camera's axes to the second's (4
  x 4).

The set is `list NAME`, the sequence the first image's folder.
@throws cv::Exception, with file and line, for any other line, a camera with skew, and a repeated pair. */
std::vector<ViewPair> readPairList(const std::string& file, const std::string& folder);

//! Rotates the images of a pair upright, and adapts cameras and pose.
void turnUpright(ViewPair& pair, cv::Mat& reference, cv::Mat& target);

}  // namespace iib_tools
