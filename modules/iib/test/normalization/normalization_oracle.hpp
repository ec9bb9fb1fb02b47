// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#ifndef OPENCV_IIB_TEST_NORMALIZATION_ORACLE_HPP
#define OPENCV_IIB_TEST_NORMALIZATION_ORACLE_HPP

#include "../test_precomp.hpp"

namespace oracle {

typedef cv::Mat_<int> Map;

//! The nearest pixel of an image, CV_8U, CV_16U or CV_32S.
inline int pixel(const cv::Mat& image, int y, int x)
{
    y = std::min(std::max(y, 0), image.rows - 1);
    x = std::min(std::max(x, 0), image.cols - 1);
    return image.depth() == CV_8U    ? image.at<uchar>(y, x)
           : image.depth() == CV_16U ? image.at<ushort>(y, x)
                                     : image.at<int>(y, x);
}

//! Means of 4 x 4 pixels around the corner between four of them, weighted 1, 3, 3, 1 in both directions, rounded.
Map halved(const Map& m);

//! Naive local normalization of CV_8U or CV_16U, with the library's integers.
cv::Mat normalizeLocally(const cv::Mat& grey, double sigma);

//! By definition, with Gaussian filters in floats: 128 + 40 (I - G*I) / (sqrt(G*(I - G*I)^2) + 2) of CV_8U.
cv::Mat normalizeByDefinition(const cv::Mat& grey, double sigma);

}  // namespace oracle

#endif
