// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#include "rotation.hpp"

#include <cmath>

#include "../precomp.hpp"
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

}  // namespace iib
}  // namespace cv
