// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#pragma once

#include "batch_job.hpp"

namespace cv { namespace iib {

//! Describes a batch of upright regions by quads, from sums over cells.
void describeUpright(const BatchJob& job);

}}  // namespace cv::iib
