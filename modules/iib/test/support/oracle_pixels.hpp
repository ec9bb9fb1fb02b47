// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#pragma once

#include "opencv2/core.hpp"

namespace oracle {

//! The nearest pixel of an image, CV_8U, CV_16U or CV_32S.
inline int pixel(const cv::Mat& image, int y, int x)
{
    y = std::min(std::max(y, 0), image.rows - 1);
    x = std::min(std::max(x, 0), image.cols - 1);
    return image.depth() == CV_8U    ? image.at<uchar>(y, x)
           : image.depth() == CV_16U ? image.at<ushort>(y, x)
                                     : image.at<int>(y, x);
}

}  // namespace oracle
