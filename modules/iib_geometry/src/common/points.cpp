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

Point2d moved(const Matx33d& by, const Point2d& point)
{
    const Vec3d q = by * Vec3d(point.x, point.y, 1);
    return {q[0] / q[2], q[1] / q[2]};
}

Rect2d spanOf(const Mat& points)
{
    if (points.empty())
        return Rect2d(0, 0, 1, 1);
    const int count = points.rows, outermost = count < 20 ? 0 : std::max(count / 50, 1);
    double least[2], most[2];
    for (int c = 0; c < 2; c++)
    {
        Mat sorted;
        cv::sort(points.col(c), sorted, SORT_EVERY_COLUMN);
        least[c] = sorted.at<double>(outermost);
        most[c] = std::max(sorted.at<double>(count - 1 - outermost), least[c] + 1);
    }
    return Rect2d(least[0], least[1], most[0] - least[0], most[1] - least[1]);
}

void writeRows(const Mat& rows, OutputArray output)
{
    if (!output.needed())
        return;
    const int type = output.fixedType() ? output.type() : rows.type(), channels = CV_MAT_CN(type);
    (channels == rows.cols ? rows.reshape(channels) : rows).convertTo(output, type);
}

void clear(OutputArray output)
{
    if (output.fixedSize())
        output.setTo(Scalar::all(std::numeric_limits<double>::quiet_NaN()));
    else
        output.release();
}

}  // namespace cv::iib
