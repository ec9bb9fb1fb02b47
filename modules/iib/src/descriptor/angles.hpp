// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#pragma once

#include "plan.hpp"
#include "regions.hpp"

namespace cv { namespace iib {

/** Sets the angles of regions as ORIENTATION_GRADIENT: the direction that prevails among the gradients between 32 x 32
 cells, each of which counts by its magnitude and by a Gaussian of half the region's radius around the centre.
@param grey CV_8U or CV_16U.
@param keypoints of the regions: of those with the same position and size, the second gets the second highest peak of
the directions, and so on. */
void findAngles(const DescriptorPlan& plan, const Mat& grey, const std::vector<KeyPoint>& keypoints,
        std::vector<SupportRegion>& regions);

}}  // namespace cv::iib
