// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#include "gradient_orientation.hpp"

#include "kernels/orientation.hpp"

namespace cv {
namespace iib {

namespace {

enum
{
    POINTS = ORIENTATION_SAMPLES * ORIENTATION_SAMPLES,
    BINS = 64,
    STEPS_PER_BIN = ORIENTATION_STEPS / BINS,
    SMOOTHINGS = 7  // by (1, 2, 1): a Gaussian of 1.9 bins, 10 degrees
};

/* round(32 exp(-2 u^2)) for u = (2 i + 1) / 32, the distances of points from the centre in radii: products are a Gaussian
 of half a radius, at most 1024. */
const int GAUSSIAN[ORIENTATION_SAMPLES / 2] = {32, 31, 30, 29, 27, 25, 23, 21, 18, 16, 14, 11, 9, 8, 6, 5};

//! The weight of each point, 0 outside the circle.
struct PointWeights
{
    int of[POINTS];

    PointWeights()
    {
        int* out = of;
        for (int row = 0; row < ORIENTATION_SAMPLES; row++)
            for (int parity = 0; parity < 2; parity++)
                for (int col = parity; col < ORIENTATION_SAMPLES; col += 2)
                {
                    const int u = std::abs(2 * col + 1 - ORIENTATION_SAMPLES);
                    const int v = std::abs(2 * row + 1 - ORIENTATION_SAMPLES);
                    const bool inside = u * u + v * v <= ORIENTATION_SAMPLES * ORIENTATION_SAMPLES;
                    *out++ = inside ? GAUSSIAN[u / 2] * GAUSSIAN[v / 2] : 0;
                }
    }
};

void smooth(int64 bins[BINS])
{
    for (int pass = 0; pass < SMOOTHINGS; pass++)
    {
        const int64 first = bins[0];
        int64 before = bins[BINS - 1];
        for (int i = 0; i < BINS; i++)
        {
            const int64 here = bins[i], after = i + 1 < BINS ? bins[i + 1] : first;
            bins[i] = before + 2 * here + after;
            before = here;
        }
    }
}

//! The bin of a peak, by height; -1 if there is none.
int peakOf(const int64 bins[BINS], int rank)
{
    int peaks[BINS], count = 0;
    for (int i = 0; i < BINS; i++)
        if (bins[i] > bins[(i + BINS - 1) % BINS] && bins[i] >= bins[(i + 1) % BINS])
            peaks[count++] = i;
    if (count == 0)
        return -1;
    std::stable_sort(peaks, peaks + count, [bins](int a, int b) { return bins[a] > bins[b]; });
    return peaks[std::min(rank, count - 1)];
}

}  // namespace

template <typename T>
float prevailingAngle(const RotatedSampleKernels<T>& kernels, const T* pixels, const int* index, int rank)
{
    static const PointWeights weights;
    int steps[POINTS], votes[POINTS];
    kernels.gradientVotes(pixels, index, weights.of, POINTS, steps, votes);
    int64 bins[BINS] = {};
    for (int i = 0; i < POINTS; i++)
        bins[steps[i] / STEPS_PER_BIN] += votes[i];
    smooth(bins);
    const int best = peakOf(bins, rank);
    if (best < 0)
        return 0;
    // The top of the parabola through the highest bin and its neighbours.
    const int64 left = bins[(best + BINS - 1) % BINS], right = bins[(best + 1) % BINS];
    const int64 curvature = left - 2 * bins[best] + right;
    const double offset = curvature == 0 ? 0 : 0.5 * (double)(left - right) / (double)curvature;
    // Steps are whole numbers and run anticlockwise.
    const double turns = (best + offset + 0.5 - 0.5 / STEPS_PER_BIN) / BINS;
    const float angle = (float)(360 * (turns <= 0 ? -turns : 1 - turns));
    return angle < 360 ? angle : 0;
}

template float prevailingAngle(const RotatedSampleKernels<short>&, const short*, const int*, int);
template float prevailingAngle(const RotatedSampleKernels<int>&, const int*, const int*, int);

}  // namespace iib
}  // namespace cv
