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

    //! How many thresholds there have to be.
    size_t stages() const { return std::max(levelSizes.size(), (size_t)1) - 1; }
};

//! Throw a cv::Exception that says what is wrong.
void checkThreshold(float threshold);
void checkLevelSizesGiven(const std::vector<int>& levelSizes);
void check(const MatcherParameters& p);

/* The arguments of DescriptorMatcher's calls. */

//! One matrix of descriptors, or several, of one image each.
std::vector<Mat> imagesOf(InputArrayOfArrays descriptors);

//! The descriptors if they are of `width` bytes each, 0 x width if there are none; throws otherwise. `byFirstCodes`
//! tells the error where the width came from: from the codes that came first, or from level sizes.
Mat checkedDescriptors(const Mat& descriptors, int width, bool byFirstCodes);

void writeParameters(FileStorage& fs, const MatcherParameters& p);
//! Those of a node that writeParameters filled, or of one that holds such a node under `name`, as Algorithm::save
//! writes it. What the node does not have stays as it was; levelSizes it must have.
MatcherParameters readParameters(const FileNode& node, const char* name, const MatcherParameters& before);

}}  // namespace cv::iib
