// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "../../iib/perf/matcher.hpp"
#include "opencv2/iib_geometry.hpp"

#if CV_VERSION_MAJOR >= 5
#include "opencv2/geometry.hpp"
#else
#include "opencv2/calib3d.hpp"
#endif
