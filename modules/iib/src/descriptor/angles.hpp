// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#pragma once

#include "plan.hpp"
#include "regions.hpp"

namespace cv { namespace iib {

/** Sets the angles of regions for ORIENTATION_GRADIENT: the peak of a histogram of gradient directions between 32 x 32
 cells, weighted by magnitude and by a Gaussian of half the region's radius.
@param grey CV_8U or CV_16U.
@param keypoints of the regions: of several with the same position and size, the second gets the second highest peak, and
so on. */
void findAngles(const DescriptorPlan& plan, const Mat& grey, const std::vector<KeyPoint>& keypoints,
        std::vector<SupportRegion>& regions);

}}  // namespace cv::iib
