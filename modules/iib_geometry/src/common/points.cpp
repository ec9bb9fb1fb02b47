// SPDX-License-Identifier: Apache-2.0
#include "points.hpp"

#include <limits>

namespace cv::iib {

Points pointsOf(InputArray given, const char* function, const char* argument)
{
    const double farthest = 1e9;
    Mat points = given.getMat();
    if (points.empty())
        return {};
    if (!points.isContinuous())
        points = points.clone();
    const int count = points.checkVector(2);
    if (count < 0 || (points.depth() != CV_32F && points.depth() != CV_64F))
        CV_Error(Error::StsBadArg,
                format("%s: %s must be N x 2 numbers, CV_32F or CV_64F", function, argument));
    Mat rows;
    points.reshape(1, count).reshape(2).convertTo(rows, CV_64F);  // also of N x 1 x 2
    if (!checkRange(rows, true, nullptr, -farthest, farthest))
        CV_Error(Error::StsBadArg, format("%s: %s has numbers that are no pixels: not finite, or beyond %g",
                                           function, argument, farthest));
    return rows;
}

void checkMatched(const Points& points1, const Points& points2, const char* function)
{
    if (points1.size() != points2.size())
        CV_Error(Error::StsUnmatchedSizes,
                format("%s: points1 has %d points, points2 %d; they must be matches, one for one", function,
                        (int)points1.size(), (int)points2.size()));
}

Point2d moved(const Matx33d& by, const Point2d& point)
{
    const Vec3d q = by * Vec3d(point.x, point.y, 1);
    return {q[0] / q[2], q[1] / q[2]};
}

Rect2d spanOf(Points points)
{
    if (points.empty())
        return Rect2d(0, 0, 1, 1);
    const size_t count = points.size(), outermost = count < 20 ? 0 : std::max<size_t>(count / 50, 1);
    Point2d least, most;
    for (double Point2d::*axis : {&Point2d::x, &Point2d::y})
    {
        const auto inOrder = [&](size_t k) {
            std::nth_element(points.begin(), points.begin() + (ptrdiff_t)k, points.end(),
                    [&](const Point2d& a, const Point2d& b) { return a.*axis < b.*axis; });
            return points[k].*axis;
        };
        least.*axis = inOrder(outermost);
        most.*axis = std::max(inOrder(count - 1 - outermost), least.*axis + 1);
    }
    return Rect2d(least, most);
}

void clear(OutputArray output)
{
    if (output.fixedSize())
        output.setTo(Scalar::all(std::numeric_limits<double>::quiet_NaN()));
    else
        output.release();
}

}  // namespace cv::iib
