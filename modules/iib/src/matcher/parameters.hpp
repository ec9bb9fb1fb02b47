// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#ifndef OPENCV_IIB_MATCHER_PARAMETERS_HPP
#define OPENCV_IIB_MATCHER_PARAMETERS_HPP

#include "../precomp.hpp"

namespace cv {
namespace iib {

struct MatcherParameters
{
    std::vector<int> levelSizes;
    int mode;
    std::vector<float> thresholds;  // one for each level but the last
    bool crossCheck;
    float maxRatio;
};

//! Throw a cv::Exception that says what is wrong.
void checkThreshold(float threshold);
void check(const MatcherParameters& p);

void writeParameters(FileStorage& fs, const MatcherParameters& p);
//! Those of a node; what it does not have stays as it was.
MatcherParameters readParameters(const FileNode& node, const MatcherParameters& before);

}  // namespace iib
}  // namespace cv

#endif
