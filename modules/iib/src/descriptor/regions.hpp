// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#pragma once

#include "../common/geometry.hpp"
#include "parameters.hpp"

namespace cv { namespace iib {

//! The area of an image that is reflected once at each side (BORDER_REFLECT_101).
inline Rect reflectedImage(Size image)
{
    return Rect(1 - image.width, 1 - image.height, 3 * image.width - 2, 3 * image.height - 2);
}

//! Region of support of a keypoint (paper, "Local Patch Generation"), in pixels of the image.
struct SupportRegion
{
    Point2f centre;     //!< KeyPoint::pt; 0 is the centre of pixel 0
    double x, y, side;  //!< top left corner of the upright region, and side; pixel i covers [i, i + 1)
    float angle;        //!< in degrees, clockwise in the image; negative: upright

    SupportRegion(Point2f centre_, double side_, float angle_ = -1)
        : centre(centre_), x(centre_.x + 0.5 - side_ / 2), y(centre_.y + 0.5 - side_ / 2), side(side_),
          angle(angle_)
    {
    }

    bool isRotated() const { return angle >= 0; }

    //! Pixels of the region inside some bounds; at least one pixel.
    Rect pixels(Rect bounds) const
    {
        const Point first = bounds.tl(), end = bounds.br();
        const Point a(edgeAt(x, first.x, end.x - 1), edgeAt(y, first.y, end.y - 1));
        const Point b(edgeAt(x + side, first.x, end.x), edgeAt(y + side, first.y, end.y));
        return Rect(a.x, a.y, std::max(b.x - a.x, 1), std::max(b.y - a.y, 1));
    }

    //! The pixels that the region may use: the image, or its reflection under BORDER_REFLECT.
    Rect bounds(Size image, int border) const
    {
        if (border != IIB::BORDER_REFLECT || isInside(image))
            return Rect(Point(), image);
        return reflectedImage(image);
    }

    //! Whether no pixel of the upright region lies outside the image.
    bool isInside(Size image) const
    {
        // edges are the floors of these
        return x + 0.5 >= 0 && x + side + 0.5 < image.width + 1 && y + 0.5 >= 0 &&
               y + side + 0.5 < image.height + 1;
    }
};

//! A keypoint's region, with ORIENTATION_GRADIENT still upright.
inline SupportRegion regionOf(const KeyPoint& keypoint, const Parameters& p)
{
    const double side = std::max((double)p.scaleFactor * keypoint.size, (double)(1 << p.granularity));
    return SupportRegion(keypoint.pt, side, p.orientation == IIB::ORIENTATION_KEYPOINT ? keypoint.angle : -1);
}

//! A rotated region is cut to this side, so that the offsets of its points fit 32 bits.
static constexpr double LARGEST_ROTATED_SIDE = 16384;

//! An upright square that contains the region at any angle, plus two pixels for roundings.
inline SupportRegion circumscribed(const SupportRegion& region)
{
    return SupportRegion(region.centre, 2 * (std::min(region.side, LARGEST_ROTATED_SIDE) * 0.7072 + 2));
}

//! The pixels of the image that a region may sample at any angle, at least one.
inline Rect rotatedPixels(const SupportRegion& region, int border, Size image)
{
    const SupportRegion square = circumscribed(region);
    const Rect r = square.pixels(square.bounds(image, border));
    const Range x = reflectedRange(r.x, r.x + r.width, image.width),
                y = reflectedRange(r.y, r.y + r.height, image.height);
    return Rect(x.start, y.start, x.size(), y.size());
}

}}  // namespace cv::iib
