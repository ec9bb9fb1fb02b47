// SPDX-License-Identifier: Apache-2.0
#include "five_points.hpp"

#include <algorithm>
#include <cmath>

namespace cv::iib {
namespace {

const int HIGHEST = 10;

//! Inline, with the degree known to the compiler: most of the time is spent here.
inline double valueAt(const double* p, int degree, double x, double& slope)
{
    double value = p[degree];
    slope = 0;
    for (int k = degree - 1; k >= 0; k--)
    {
        slope = slope * x + value;
        value = value * x + p[k];
    }
    return value;
}

//! The root between `low` and `high`, where the signs differ. Newton's steps, or bisection where a step would leave the interval.
template <int degree>
double rootBetween(const double* p, double low, double high, bool rising, double precision)
{
    double x = .5 * (low + high), slope;
    for (int round = 0; round < 60; round++)
    {
        const double value = valueAt(p, degree, x, slope);
        ((value < 0) == rising ? low : high) = x;
        double next = x - value / slope;
        if (!(next > low && next < high))
            next = .5 * (low + high);
        if (std::abs(next - x) < precision)
            return next;
        x = next;
    }
    return x;
}

double (*const ROOT_BETWEEN[])(const double*, double, double, bool, double) = {nullptr, rootBetween<1>,
        rootBetween<2>, rootBetween<3>, rootBetween<4>, rootBetween<5>, rootBetween<6>, rootBetween<7>,
        rootBetween<8>, rootBetween<9>, rootBetween<HIGHEST>};

//! Roots in [-1, 1], ascending. Between two roots of the derivative there is at most one.
int rootsInUnit(const double* p, int degree, double* roots)
{
    double derivatives[HIGHEST][HIGHEST + 1], ends[HIGHEST + 1], slope;
    std::copy(p, p + degree + 1, derivatives[0]);
    for (int d = 1; d < degree; d++)
        for (int k = 0; k <= degree - d; k++)
            derivatives[d][k] = (k + 1) * derivatives[d - 1][k + 1];
    int count = 0;
    for (int d = degree - 1; d >= 0; d--)
    {
        const double precision = d ? 1e-4 : 1e-9;  // of the last step: the error is about its square
        std::copy(roots, roots + count, ends);
        ends[count] = 1;
        const int extremes = count;
        double low = -1, lowValue = valueAt(derivatives[d], degree - d, low, slope);
        count = 0;
        for (int k = 0; k <= extremes; k++)
        {
            const double value = valueAt(derivatives[d], degree - d, ends[k], slope);
            if ((value < 0) != (lowValue < 0))
                roots[count++] =
                        ROOT_BETWEEN[degree - d](derivatives[d], low, ends[k], lowValue < 0, precision);
            low = ends[k];
            lowValue = value;
        }
    }
    return count;
}

}  // namespace

int realRoots(const double* coefficients, int degree, double* roots)
{
    CV_DbgAssert(degree > 0 && degree <= HIGHEST);
    int count = rootsInUnit(coefficients, degree, roots);
    // the roots outside [-1, 1] are inverses of the reversed polynomial's roots
    double reversed[HIGHEST + 1], inverses[HIGHEST];
    std::reverse_copy(coefficients, coefficients + degree + 1, reversed);
    const int large = rootsInUnit(reversed, degree, inverses);
    for (int i = 0; i < large && count < degree; i++)
        if (std::abs(inverses[i]) < 1 && inverses[i] != 0)
            roots[count++] = 1 / inverses[i];
    return count;
}

}  // namespace cv::iib
