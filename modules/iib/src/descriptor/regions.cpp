// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#include "regions.hpp"

#include "rotation.hpp"

namespace cv {
namespace iib {

SupportRegion circumscribed(const SupportRegion& region)
{
    return SupportRegion(region.centre, 2 * (std::min(region.side, LARGEST_ROTATED_SIDE) * 0.7072 + 2));
}

Rect rotatedPixels(const SupportRegion& region, int border, Size image)
{
    const SupportRegion square = circumscribed(region);
    const Rect r = square.pixels(square.bounds(image, border));
    const Range x = reflectedRange(r.x, r.x + r.width, image.width),
                y = reflectedRange(r.y, r.y + r.height, image.height);
    return Rect(x.start, y.start, x.size(), y.size());
}

bool isInsideRotated(const SupportRegion& region, float angle, Size image)
{
    const Rotation rotation(angle);
    const double half = std::min(region.side, LARGEST_ROTATED_SIDE) / 2;
    const double reach = half * (std::abs(rotation.cosine) + std::abs(rotation.sine));
    const double x = region.centre.x + 0.5, y = region.centre.y + 0.5;
    return x - reach >= 0 && x + reach <= image.width && y - reach >= 0 && y + reach <= image.height;
}

}  // namespace iib
}  // namespace cv
