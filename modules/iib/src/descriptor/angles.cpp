// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#include <array>
#include <map>
#include <numeric>

#include "grid_pixels.hpp"

namespace cv { namespace iib {

namespace {

enum
{
    CELLS = 32,         //!< in a row of the grid over a region whose gradients vote for its angle
    SUB = 2,            //!< a cell has SUB x SUB points
    INNER = CELLS - 2,  // cells with neighbours on all sides
    VOTES = INNER * INNER,
    BINS = 64,
    STEPS_PER_BIN = ORIENTATION_STEPS / BINS,
    SMOOTHINGS = 6,  // by sums of SMOOTHED bins: nearly a Gaussian of 3.5 bins, 19 degrees
    SMOOTHED = 5
};

/* round(32 exp(-2 u^2)) for u = (2 i + 1) / 32, the distances of cells from the centre in radii: products are a
 Gaussian of half a radius, at most 1024. */
const int GAUSSIAN[CELLS / 2 - 1] = {32, 31, 30, 29, 27, 25, 23, 21, 18, 16, 14, 11, 9, 8, 6};

//! The weight of each inner cell, 0 outside the circle.
std::vector<int> cellWeights()
{
    std::vector<int> weights(VOTES + ROW_PADDING, 0);
    for (int row = 0; row < INNER; row++)
        for (int col = 0; col < INNER; col++)
        {
            const int u = std::abs(2 * col + 1 - INNER), v = std::abs(2 * row + 1 - INNER);
            if (u * u + v * v <= CELLS * CELLS)
                weights[row * INNER + col] = GAUSSIAN[u / 2] * GAUSSIAN[v / 2];
        }
    return weights;
}

//! The sums of intensities of all cells, row by row.
template <typename T>
void sumCells(const RotatedSampleKernels<T>& kernels, const T* pixels, const int* index, int* out)
{
    int planes[GROUP_CHANNELS][CELLS * CELLS];
    int* const sums[GROUP_CHANNELS] = {planes[0], planes[1], planes[2], planes[3]};
    kernels.mapSums(pixels, index, CELLS, SUB * SUB, sums);
    const int* in = planes[3];
    for (int row = 0; row < CELLS; row++, out += CELLS)
        for (int parity = 0; parity < 2; parity++)
            for (int col = parity; col < CELLS; col += 2)
                out[col] = *in++;
}

void smooth(int64 bins[BINS])
{
    for (int pass = 0; pass < SMOOTHINGS; pass++)
    {
        int64 before[BINS];
        std::copy_n(bins, (int)BINS, before);
        for (int i = 0; i < BINS; i++)
            for (int d = 1; d <= SMOOTHED / 2; d++)
                bins[i] += before[(i + d) % BINS] + before[(i + BINS - d) % BINS];
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

/** A peak of the smoothed histogram of the directions of gradients (Sobel 3x3) between cells.
@param pixels, index of the points of CELLS x CELLS cells, as for mapSums; the fourth value of a pixel is its intensity.
@param rank 0 for the highest peak, 1 for the next, and so on; the lowest if there are fewer.
@return degrees, 0 <= angle < 360, clockwise in the image; 0 if there is no peak. */
template <typename T>
float prevailingAngle(const DescriptorKernels& kernels, const T* pixels, const int* index, int rank)
{
    static const std::vector<int> weights = cellWeights();
    int cells[CELLS * CELLS + ROW_PADDING];
    sumCells(kernels.pixels(T()).rotated, pixels, index, cells);
    const RowKernels<int>& rows = kernels.pixels(int()).rows;
    int gx[VOTES + ROW_PADDING], gy[VOTES + ROW_PADDING], steps[VOTES + ROW_PADDING],
            votes[VOTES + ROW_PADDING];
    for (int row = 0; row < INNER; row++)
    {
        const int* const above = cells + row * CELLS;
        const ImageChannelRows<int> out = {
                {0, 0, steps + row * INNER, 0, gx + row * INNER, gy + row * INNER}};
        rows.imageChannels({above, above + CELLS, above + 2 * CELLS}, 0, out, 0, INNER);
    }
    kernels.pixels(T()).rotated.gradientVotes(gx, gy, weights.data(), VOTES, votes);
    int64 bins[BINS] = {};
    for (int i = 0; i < VOTES; i++)
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

//! How many earlier keypoints have the same position and size.
std::vector<int> ranksOf(const std::vector<KeyPoint>& keypoints)
{
    std::map<std::array<float, 3>, int> seen;
    std::vector<int> ranks;
    ranks.reserve(keypoints.size());
    for (const KeyPoint& kp : keypoints)
        ranks.push_back(seen[{{kp.pt.x, kp.pt.y, kp.size}}]++);
    return ranks;
}

template <typename T>
void findInBatch(const DescriptorPlan& plan, const Mat& grey, const KeyPointBatch& batch,
        const std::vector<int>& ranks, const std::vector<Rect>& needed, Workspace& workspace,
        std::vector<SupportRegion>& regions)
{
    const std::vector<std::vector<Channel>> packs(
            1, std::vector<Channel>(1, Channel{IIB::CHANNEL_INTENSITY, grey}));
    GridPixels<T> pixels(plan.kernels, packs, batch, workspace);
    for (int k : batch.keypoints)
    {
        pixels.moveTo(needed[k],
                gridOf(regions[k], Rotation(0), CELLS * SUB, SUB, plan.parameters.border, grey.size()));
        regions[k].angle = prevailingAngle(plan.kernels, pixels.pixels(0), pixels.indices(), ranks[k]);
    }
}

}  // namespace

void findAngles(const DescriptorPlan& plan, const Mat& grey, const std::vector<KeyPoint>& keypoints,
        std::vector<SupportRegion>& regions)
{
    std::vector<Rect> pixels;
    for (const SupportRegion& region : regions)
        pixels.push_back(rotatedPixels(region, plan.parameters.border, grey.size()));
    const std::vector<int> ranks = ranksOf(keypoints);
    std::vector<int> all(keypoints.size());
    std::iota(all.begin(), all.end(), 0);
    const std::vector<std::vector<int>> batches = cutBatches(pixels, all, getNumThreads());
    const auto find = grey.depth() == CV_16U ? findInBatch<int> : findInBatch<short>;
    parallelJobs((int)batches.size(), [&](int i, Workspace& workspace) {
        find(plan, grey, makeBatch(pixels, batches[i]), ranks, pixels, workspace, regions);
    });
}

}}  // namespace cv::iib
