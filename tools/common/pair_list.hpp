// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "views.hpp"

namespace iib_tools {

/** Pairs of images with cameras and poses, as SuperGlue's `match_pairs.py` reads them, a line each: the paths of two images below
`folder`, by how many quarters each was taken turned clockwise, both camera matrices (nine numbers a matrix, row by row) and the
pose that takes the first camera's axes to the second's (4 x 4). The set is `list NAME`, the sequence the first image's folder.
@throws cv::Exception, with file and line, for anything else, a camera with skew, and a pair that is there twice. */
std::vector<ViewPair> readPairList(const std::string& file, const std::string& folder);

//! Turns two images that were taken turned upright, and the pair's cameras and pose with them.
void turnUpright(ViewPair& pair, cv::Mat& reference, cv::Mat& target);

}  // namespace iib_tools
