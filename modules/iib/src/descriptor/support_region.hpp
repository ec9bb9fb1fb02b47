// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#ifndef OPENCV_IIB_DESCRIPTOR_SUPPORT_REGION_HPP
#define OPENCV_IIB_DESCRIPTOR_SUPPORT_REGION_HPP

#include "parameters.hpp"

namespace cv {
namespace iib {

//! The edge of pixels nearest to a position, in [0, limit]: on positive numbers the cast is a floor.
static inline int edgeAt(double position, int limit)
{
    return (int)std::min(std::max(position + 0.5, 0.), (double)limit);
}

//! A bound of the lengths of the n cells in a row of a support region.
static inline double longestCell(double side, int n) { return std::ceil(side / n); }

/** Region of support of a keypoint and its quadtree of cells (paper, "Local Patch Generation"). Pure
 geometry, in pixels of the image. */
struct SupportRegion
{
    double x, y, side;  //!< top left corner and side; pixel i covers [i, i + 1)

    //! KeyPoint::pt counts from the centre of pixel 0.
    SupportRegion(Point2f centre, double side_)
        : x(centre.x + 0.5 - side_ / 2), y(centre.y + 0.5 - side_ / 2), side(side_)
    {
    }

    SupportRegion(const KeyPoint& keypoint, float scaleFactor, int granularity)
        : SupportRegion(
                  keypoint.pt, std::max((double)scaleFactor * keypoint.size, (double)(1 << granularity)))
    {
    }

    //! Pixels of the image that hold the part of the support region inside it; one of the border if there is none.
    Rect pixels(Size image) const
    {
        const Point a(edgeAt(x, image.width - 1), edgeAt(y, image.height - 1));
        const Point b(edgeAt(x + side, image.width), edgeAt(y + side, image.height));
        return Rect(a.x, a.y, std::max(b.x - a.x, 1), std::max(b.y - a.y, 1));
    }

    //! Whether no pixel of the support region lies outside the image.
    bool isInside(Size image) const
    {
        return std::floor(x + 0.5) >= 0 && std::floor(x + side + 0.5) <= image.width &&
               std::floor(y + 0.5) >= 0 && std::floor(y + side + 0.5) <= image.height;
    }
};

}  // namespace iib
}  // namespace cv

#endif
