// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#pragma once

#include "../precomp.hpp"

namespace cv { namespace iib {

//! The place in [0, size) of a pixel after up to two reflections by BORDER_REFLECT_101.
inline int reflected(int place, int size)
{
    const int folded = std::abs(place);
    return std::max(std::min(folded, 2 * (size - 1) - folded), 0);
}

//! The pixels of a row (or column) of `size` pixels that [begin, end) reads, some of them by reflection.
inline Range reflectedRange(int begin, int end, int size)
{
    const int first = std::min(begin, 2 * size - 1 - end), last = std::max(end, 1 - begin);
    return Range(std::max(first, 0), std::min(last, size));
}

/** Cosine and sine of a keypoint's angle, the same on every machine. Functions of the C library differ in the last place,
 which would change bits. */
struct Rotation
{
    double cosine, sine;  //!< error below 1e-15

    //! @param degrees clockwise in the image; any finite number.
    explicit Rotation(float degrees)
    {
        double angle = std::fmod(degrees, 360.f);  // exact; rounding a huge angle would depend on the machine
        if (angle < 0)
            angle += 360;
        const int quadrant = (int)(angle / 90) & 3;
        const double rest = angle - 90 * quadrant;
        const bool upper = rest > 45;  // sin(x) = cos(90 degrees - x)
        const double radians = (upper ? 90 - rest : rest) * (CV_PI / 180);
        const double small = radians * series(radians, 14), large = series(radians, 15);
        const double s = upper ? large : small, c = upper ? small : large;
        const double sines[] = {s, c, -s, -c};
        sine = sines[quadrant];
        cosine = sines[(quadrant + 1) & 3];
    }

private:
    //! Taylor's series on [0, pi / 4], to 1e-16: from last = 14 on that of sin(x) / x, from 15 on that of cos(x).
    static double series(double x, int last)
    {
        double sum = 1;
        for (int k = last; k > 0; k -= 2)
            sum = 1 - x * x * sum / (k * (k + 1));
        return sum;
    }
};

//! Votes of angles, whole degrees apart; with the sums of their parts of degrees.
class RotationVotes
{
public:
    RotationVotes() : counts(BINS), sums(BINS) {}

    //! @param degrees from 0 to 360.
    void add(double degrees)
    {
        const int bin = std::min((int)degrees, BINS - 1);
        counts[bin]++;
        sums[bin] += degrees - bin;
    }

    //! Degrees, 0 or more and less than 360: the mean of the votes around the peak; -1 without votes.
    double peak() const
    {
        int best = -1;
        double most = 0;
        for (int i = 0; i < BINS; i++)
        {
            double score = 0;
            for (int j = -REACH; j <= REACH; j++)
                score += (REACH + 1 - std::abs(j)) * counts[(i + j + BINS) % BINS];
            if (score > most)
            {
                most = score;
                best = i;
            }
        }
        if (best < 0)
            return -1;
        double count = 0, sum = 0;
        for (int j = -REACH; j <= REACH; j++)
        {
            const int bin = (best + j + BINS) % BINS;
            count += counts[bin];
            sum += counts[bin] * j + sums[bin];
        }
        const double angle = std::fmod(best + sum / count + 360, 360);
        return angle < 360 ? angle : 0;
    }

private:
    static constexpr int BINS = 360;
    static constexpr int REACH = 4;  //!< a vote counts for the bins this near, less for farther ones

    std::vector<double> counts, sums;
};

}}  // namespace cv::iib
