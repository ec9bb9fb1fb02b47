// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#pragma once

#if defined __FAST_MATH__ || (defined __FINITE_MATH_ONLY__ && __FINITE_MATH_ONLY__)
#error "-ffast-math lets NaN through all checks and changes bits of the descriptor: compile this module with -fno-fast-math"
#endif

#include "opencv2/core.hpp"
#include "opencv2/core/utility.hpp"
#include "opencv2/iib.hpp"
