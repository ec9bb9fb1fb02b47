// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "opencv2/core.hpp"

namespace cv::iib {

//! Transforms from camera 1's to camera 2's axes; t has length 1.
struct RelativePose
{
    Matx33d R;
    Vec3d t;
};

inline Matx33d crossProduct(const Vec3d& t)
{
    return Matx33d(0, -t[2], t[1], t[2], 0, -t[0], -t[1], t[0], 0);
}

//! Writes a block of a matrix, whose first entry is at this row and column.
template <int M, int N, int H, int W>
void setBlock(Matx<double, M, N>& matrix, int row, int column, const Matx<double, H, W>& block)
{
    for (int y = 0; y < H; y++)
        for (int x = 0; x < W; x++)
            matrix(row + y, column + x) = block(y, x);
}

inline Matx33d essentialOf(const RelativePose& pose) { return crossProduct(pose.t) * pose.R; }

//! Two unit vectors that form a right-handed system with t: b and t x b in findRelativePose's documentation.
Matx<double, 3, 2> tangentsOf(const Vec3d& t);

//! Changes a pose by a rotation vector in camera 2's axes, and by two angles along the tangents of t.
RelativePose moved(const RelativePose& pose, const Vec<double, 5>& step);

//! The step that moves `pose` to `other`.
Vec<double, 5> stepBetween(const RelativePose& pose, const RelativePose& other);

//! The pose with the cameras swapped.
inline RelativePose inverse(const RelativePose& pose) { return {pose.R.t(), -(pose.R.t() * pose.t)}; }

//! The matrix that converts a small step of a pose to a step of its inverse.
Matx<double, 5, 5> stepOfInverse(const RelativePose& pose);

//! The four poses of an essential matrix.
void posesOf(const Matx33d& essential, RelativePose (&poses)[4]);

//! Whether the point seen at `first` and `second` lies in front of both cameras.
bool inFront(const RelativePose& pose, const Point2d& first, const Point2d& second);

}  // namespace cv::iib
