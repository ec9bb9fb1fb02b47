// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#pragma once

#include "../../precomp.hpp"

namespace cv { namespace iib {

/* Mappings f(x) of the four cell means of a quad to bits (paper, "Binary Bit Formulation"). V is a vector of integers, or of
 doubles that hold integers, with least, greatest, fourTimes and quarter; put(bit, b) takes the result of a comparison. No
 value exceeds four times the largest x. */

//! Equation (1): x_i > mean(x).
struct MeanMapping
{
    static constexpr int BITS = 4;

    template <typename V, typename Put> static void map(const V x[4], const Put& put)
    {
        const V mean = quarter(V((x[0] + x[1]) + (x[2] + x[3])));
        for (int i = 0; i < 4; i++)
            put(i, x[i] > mean);
    }
};

//! x_i is the largest of the four, or the smallest.
template <bool LARGEST> struct ExtremeMapping
{
    static constexpr int BITS = 4;

    template <typename V, typename Put> static void map(const V x[4], const Put& put)
    {
        const V extreme = LARGEST ? greatest(greatest(x[0], x[1]), greatest(x[2], x[3]))
                                  : least(least(x[0], x[1]), least(x[2], x[3]));
        for (int i = 0; i < 4; i++)
            put(i, x[i] == extreme);
    }
};

//! Equation (2), with x - min(x) and R = max(x) - min(x) both four times as large.
struct QuartileMapping
{
    static constexpr int BITS = 8;

    template <typename V, typename Put> static void map(const V x[4], const Put& put)
    {
        const V bottom = least(least(x[0], x[1]), least(x[2], x[3]));
        const V range = greatest(greatest(x[0], x[1]), greatest(x[2], x[3])) - bottom;
        const V twice = range + range;
        for (int i = 0; i < 4; i++)
        {
            const V a4 = fourTimes(V(x[i] - bottom));
            // thresholds passed: 0 to 3, in binary
            put(2 * i, a4 > twice);
            put(2 * i + 1, (a4 > range) ^ (a4 > twice) ^ (a4 > twice + range));
        }
    }
};

//! The rank of x_i, 0 the smallest; among equals the lower index ranks lower.
struct SortMapping
{
    static constexpr int BITS = 8;

    template <typename V, typename Put> static void map(const V x[4], const Put& put)
    {
        for (int i = 0; i < 4; i++)
        {
            const int j = (i + 1) & 3, k = (i + 2) & 3, l = (i + 3) & 3;
            const auto a = ranksAfter(x, i, j), b = ranksAfter(x, i, k), c = ranksAfter(x, i, l);
            put(2 * i, (a & b) | (c & (a ^ b)));
            put(2 * i + 1, a ^ b ^ c);
        }
    }

private:
    template <typename V> static auto ranksAfter(const V x[4], int i, int j) -> decltype(x[0] > x[0])
    {
        return i < j ? x[i] > x[j] : x[i] >= x[j];
    }
};

}}  // namespace cv::iib
