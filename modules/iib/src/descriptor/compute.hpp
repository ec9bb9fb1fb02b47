// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#ifndef OPENCV_IIB_DESCRIPTOR_COMPUTE_HPP
#define OPENCV_IIB_DESCRIPTOR_COMPUTE_HPP

#include "parameters.hpp"

namespace cv {
namespace iib {

/** Describes keypoints (paper, algorithm 1). All arguments have passed their checks.

@param extra maps of the image's size.
@param descriptors keypoints.size() rows of sum(levelBytes(parameters)), CV_8U, allocated.
 */
void describe(const Parameters& parameters, const Mat& image, const std::vector<Mat>& extra,
        const std::vector<KeyPoint>& keypoints, Mat& descriptors);

}  // namespace iib
}  // namespace cv

#endif
