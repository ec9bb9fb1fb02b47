// SPDX-License-Identifier: Apache-2.0
#include "points.hpp"

#include <limits>

namespace cv::iib {

Mat pointsOf(InputArray given, const char* function, const char* argument)
{
    const double farthest = 1e9;
    Mat points = given.getMat();
    if (points.empty())
        return Mat(0, 2, CV_64F);
    if (!points.isContinuous())
        points = points.clone();
    const int count = points.checkVector(2);
    if (count < 0 || (points.depth() != CV_32F && points.depth() != CV_64F))
        CV_Error(Error::StsBadArg,
                format("%s: %s must be N x 2 numbers, CV_32F or CV_64F", function, argument));
    Mat rows;
    points.reshape(1, count).convertTo(rows, CV_64F);
    if (!checkRange(rows, true, nullptr, -farthest, farthest))
        CV_Error(Error::StsBadArg, format("%s: %s has numbers that are no pixels: not finite, or beyond %g",
                                           function, argument, farthest));
    return rows;
}

void checkMatched(const Mat& points1, const Mat& points2, const char* function)
{
    if (points1.rows != points2.rows)
        CV_Error(Error::StsUnmatchedSizes,
                format("%s: points1 has %d points, points2 %d; they must be matches, one for one", function,
                        points1.rows, points2.rows));
}

void clear(OutputArray output)
{
    if (output.fixedSize())
        output.setTo(Scalar::all(std::numeric_limits<double>::quiet_NaN()));
    else
        output.release();
}

}  // namespace cv::iib
