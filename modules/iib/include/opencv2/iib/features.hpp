// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#ifndef OPENCV_IIB_FEATURES_HPP
#define OPENCV_IIB_FEATURES_HPP

//! @cond IGNORED
// Feature2D and DescriptorMatcher, whose module has another name from OpenCV 5 on.
#include "opencv2/core/version.hpp"
#if CV_VERSION_MAJOR >= 5
#include "opencv2/features.hpp"
#else
#include "opencv2/features2d.hpp"
#endif
//! @endcond

#endif
