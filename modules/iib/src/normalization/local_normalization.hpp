// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#pragma once

#include "../precomp.hpp"

namespace cv { namespace iib {

/** Local normalization: 128 + 40 (I - G*I) / (sqrt(G*(I - G*I)^2) + 2), as 8-bit pixels.

G approximates a Gaussian: the image is halved several times (means of 4 x 4 pixels, weighted 1, 3, 3, 1), blurred, and
interpolated back. Its variance is sigma^2, up to the rounding of a weight, and at least 1.5.

@param grey CV_8U or CV_16U, one channel, not empty. The largest value of 16-bit pixels counts as 255.
@param sigma in pixels, 1 to 256. */
Mat normalizeLocally(const Mat& grey, double sigma);

}}  // namespace cv::iib
