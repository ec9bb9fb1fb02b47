// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#include "rotated_region.hpp"

namespace cv {
namespace iib {

static const double LARGEST_SIDE = 16384;  // so that a point's offset fits 32 bits

//! An upright square that holds the region at any angle, and two pixels for roundings.
static SupportRegion circumscribed(const SupportRegion& region, Point2f centre)
{
    return SupportRegion(centre, 2 * (std::min(region.side, LARGEST_SIDE) * 0.7072 + 2));
}

SampleGrid gridOf(const SupportRegion& region, Point2f centre, const Rotation& rotation, int n, int sub,
        int border, Size image)
{
    SampleGrid g;
    g.n = n;
    g.sub = sub;
    g.image = image;
    g.reflect = circumscribed(region, centre).bounds(image, border).size() != image;
    const double spacing = std::min(region.side, LARGEST_SIDE) / g.n;
    g.stepX = cvRound(rotation.cosine * spacing * 65536);
    g.stepY = cvRound(rotation.sine * spacing * 65536);
    const double far = 1 << 29;  // beyond any image
    const int64 x = (int64)std::floor(std::min(std::max((double)centre.x, -far), far) * 131072 + 65536.5);
    const int64 y = (int64)std::floor(std::min(std::max((double)centre.y, -far), far) * 131072 + 65536.5);
    g.x = (int)(x >> 17);
    g.y = (int)(y >> 17);
    g.fracX = (int)(x & 131071);
    g.fracY = (int)(y & 131071);
    return g;
}

Rect rotatedPixels(const SupportRegion& region, Point2f centre, int border, Size image)
{
    const SupportRegion square = circumscribed(region, centre);
    const Rect r = square.pixels(square.bounds(image, border));
    const Range x = reflectedRange(r.x, r.x + r.width, image.width),
                y = reflectedRange(r.y, r.y + r.height, image.height);
    return Rect(x.start, y.start, x.size(), y.size());
}

bool rotatedIsInside(const SupportRegion& region, Point2f centre, float angle, Size image)
{
    const Rotation rotation(angle);
    const double half = std::min(region.side, LARGEST_SIDE) / 2;
    const double reach = half * (std::abs(rotation.cosine) + std::abs(rotation.sine));
    const double x = centre.x + 0.5, y = centre.y + 0.5;
    return x - reach >= 0 && x + reach <= image.width && y - reach >= 0 && y + reach <= image.height;
}

}  // namespace iib
}  // namespace cv
