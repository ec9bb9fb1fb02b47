// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#ifndef OPENCV_IIB_HPP
#define OPENCV_IIB_HPP

/**
@defgroup iib Illumination-insensitive binary descriptor and hierarchical matching

A binary descriptor that compares each image patch with its neighbours on a quadtree over the
keypoint's region of support @cite Lin2023IIB.
*/

#include "opencv2/iib/descriptor.hpp"
#include "opencv2/iib/matcher.hpp"

#endif
