// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#ifndef OPENCV_IIB_TEST_HESSIAN_ORACLE_HPP
#define OPENCV_IIB_TEST_HESSIAN_ORACLE_HPP

#include "../test_precomp.hpp"

namespace oracle {

//! The bits of HessianDetector for CV_8U or CV_16U: a whole image per scale, pixel by pixel, with its integers. For the
//! definition of a keypoint see blobsByDefinition.
std::vector<cv::KeyPoint> findBlobs(const cv::Mat& grey, const cv::iib::HessianDetector& parameters);

/* The definition in the header of HessianDetector, with OpenCV's Gaussians and floating point, at the image's resolution:
 largest values of sigma^4 (Ixx Iyy - Ixy^2), in units of 40 grey levels of the normalized image, among their neighbours in
 place and scale. All of them, in any order, of whole pixels and scales. */
std::vector<cv::KeyPoint> blobsByDefinition(const cv::Mat& grey, const cv::iib::HessianDetector& parameters);

}  // namespace oracle

#endif
