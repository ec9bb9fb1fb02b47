// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "opencv2/core.hpp"
#include "opencv2/core/utility.hpp"

// The estimators of poses, in OpenCV 4 and 5.
#if CV_VERSION_MAJOR >= 5
#include "opencv2/geometry.hpp"
#else
#include "opencv2/calib3d.hpp"
#endif
