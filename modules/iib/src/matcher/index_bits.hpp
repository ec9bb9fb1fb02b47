// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#ifndef OPENCV_IIB_MATCHER_INDEX_BITS_HPP
#define OPENCV_IIB_MATCHER_INDEX_BITS_HPP

namespace cv {
namespace iib {

//! Of the number of a train code among all images, as storage and search keep it.
const int INDEX_BITS = 40;

}  // namespace iib
}  // namespace cv

#endif
