// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#pragma once

#include "batch_job.hpp"

namespace cv { namespace iib {

/** Describes a batch of rotated regions by quads. Integral images cannot serve, since |gx| does not rotate with the region: it is
 sampled on a grid of points, and the gradient is rotated at each. */
void describeRotated(const BatchJob& job);

}}  // namespace cv::iib
