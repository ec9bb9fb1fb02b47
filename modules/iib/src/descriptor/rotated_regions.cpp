// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#include "rotated_regions.hpp"

#include "kernels/kernels.hpp"

namespace cv {
namespace iib {

//! Taylor series on [0, pi / 4], where the first term left out is below 1e-16.
static double smallSine(double x)
{
    const double x2 = x * x;
    double sum = 1;
    for (int k = 14; k >= 2; k -= 2)
        sum = 1 - x2 * sum / (k * (k + 1));
    return x * sum;
}

static double smallCosine(double x)
{
    const double x2 = x * x;
    double sum = 1;
    for (int k = 15; k >= 1; k -= 2)
        sum = 1 - x2 * sum / (k * (k + 1));
    return sum;
}

Rotation::Rotation(float degrees)
{
    double angle = std::fmod(
            degrees, 360.f);  // exact; rounding a huge angle to integers would depend on the machine
    steps = cvRound((float)angle * ORIENTATION_STEPS / 360);
    if (angle < 0)
        angle += 360;
    const int quadrant = (int)(angle / 90) & 3;
    const double rest = angle - 90 * quadrant;
    const bool upper = rest > 45;  // there the sine is the cosine of what is left to 90 degrees
    const double radians = (upper ? 90 - rest : rest) * (CV_PI / 180);
    const double s = upper ? smallCosine(radians) : smallSine(radians);
    const double c = upper ? smallSine(radians) : smallCosine(radians);
    const double sines[] = {s, c, -s, -c};
    sine = sines[quadrant];
    cosine = sines[(quadrant + 1) & 3];
}

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
