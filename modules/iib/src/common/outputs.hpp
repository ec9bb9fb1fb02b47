// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#pragma once

#include "../precomp.hpp"

namespace cv { namespace iib {

/** Writes rows of numbers to a matrix, or to what has a type or a size of its own: numbers of another depth, or elements
 that are rows each, as those of std::vector<Point2f> and std::vector<Vec3d>. */
inline void writeRows(const Mat& rows, OutputArray out)
{
    if (!out.needed())
        return;
    const int type = out.fixedType() ? out.type() : rows.type(), channels = CV_MAT_CN(type);
    (channels == rows.cols ? rows.reshape(channels) : rows)
            .convertTo(out, type);  // of no rows OpenCV 4.14 creates this type
}

}}  // namespace cv::iib
