// SPDX-License-Identifier: Apache-2.0

#ifndef OPENCV_IIB_GEOMETRY_HPP
#define OPENCV_IIB_GEOMETRY_HPP

#include "opencv2/iib/alignment.hpp"
#include "opencv2/iib/localization.hpp"
#include "opencv2/iib/relative_pose.hpp"
#include "opencv2/iib/verdict.hpp"
#include "opencv2/iib/views.hpp"

/** @defgroup iib_geometry Poses from matches of the illumination-insensitive binary descriptor */

#endif
