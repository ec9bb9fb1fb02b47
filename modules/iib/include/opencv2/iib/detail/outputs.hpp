// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#ifndef OPENCV_IIB_DETAIL_OUTPUTS_HPP
#define OPENCV_IIB_DETAIL_OUTPUTS_HPP

#include "opencv2/core.hpp"

namespace cv { namespace iib {

//! @cond IGNORED

/** Writes rows of numbers to a matrix, converted to its type if that is fixed, or to a vector whose elements are rows, such
 as std::vector<Point2f>. */
inline void writeRows(const Mat& rows, OutputArray out)
{
    if (!out.needed())
        return;
    const int type = out.fixedType() ? out.type() : rows.type(), channels = CV_MAT_CN(type);
    (channels == rows.cols ? rows.reshape(channels) : rows)
            .convertTo(out, type);  // OpenCV 4.14 needs the type for an empty matrix
}

//! @endcond

}}  // namespace cv::iib

#endif
