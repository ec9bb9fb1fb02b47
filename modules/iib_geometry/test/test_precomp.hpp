// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "opencv2/iib.hpp"
#include "opencv2/iib_geometry.hpp"
#include "opencv2/ts.hpp"

// As in src/precomp.hpp, which OpenCV's precompiled copy of this header would search in another module.
#if CV_VERSION_MAJOR >= 5
#include "opencv2/geometry.hpp"
#else
#include "opencv2/calib3d.hpp"
#endif
