// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#pragma once

#include "../precomp.hpp"

namespace cv { namespace iib {

struct MatcherParameters
{
    std::vector<int> levelSizes;  //!< empty: a single level, as wide as the first codes
    int mode = 0;
    std::vector<float> thresholds;  //!< one for each level but the last
    bool crossCheck = false;
    float maxRatio = 1;

    //! Number of thresholds.
    size_t stages() const { return std::max(levelSizes.size(), (size_t)1) - 1; }
};

//! Throw a cv::Exception that says what is wrong.
void checkThreshold(float threshold);
void checkLevelSizesGiven(const std::vector<int>& levelSizes);
void check(const MatcherParameters& p);

/* The arguments of DescriptorMatcher's calls. */

//! One matrix of descriptors, or several, of one image each.
std::vector<Mat> imagesOf(InputArrayOfArrays descriptors);

//! The descriptors; 0 x width if there are none. Throws unless each has `width` bytes.
//! @param byFirstCodes for the error: the width comes from the first codes, not from level sizes.
Mat checkedDescriptors(const Mat& descriptors, int width, bool byFirstCodes);

void writeParameters(FileStorage& fs, const MatcherParameters& p);
//! Reads the node of writeParameters, or one that holds it under `name`, as Algorithm::save writes it. Missing parameters,
//! except levelSizes, keep the values of `before`.
MatcherParameters readParameters(const FileNode& node, const char* name, const MatcherParameters& before);

}}  // namespace cv::iib
