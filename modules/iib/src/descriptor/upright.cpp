// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#include "upright.hpp"

#include "kernels/integral.hpp"
#include "bit_encoder.hpp"

namespace cv {
namespace iib {

namespace {

/* Edges that cut each cell of another grid into parts x parts. They are made of pixels of the image, not of the support region,
 which may be so much larger that any number of its parts is needed to cut the image once. */
struct FineEdges
{
    std::vector<int> x, y;

    FineEdges(const int* xEdges, const int* yEdges, int n, int parts)
        : x(split(xEdges, n, parts)), y(split(yEdges, n, parts))
    {
    }

    //! The most pixels that a cell has.
    double largestCell() const { return (double)largestStep(x) * largestStep(y); }

private:
    static std::vector<int> split(const int* edges, int n, int parts)
    {
        std::vector<int> out(1, edges[0]);
        for (int i = 1; i <= n; i++)
            for (int k = 1; k <= parts; k++)
                out.push_back(edges[i - 1] + (int)((int64)(edges[i] - edges[i - 1]) * k / parts));
        out.resize(paddedEdges(n * parts), out.back());
        return out;
    }

    static int largestStep(const std::vector<int>& edges)
    {
        int largest = 0;
        for (size_t i = 1; i < edges.size(); i++)
            largest = std::max(largest, edges[i] - edges[i - 1]);
        return largest;
    }
};

//! Sums of a grid from those of a finer one.
template <typename Sum> void gather(const CellGrid<Sum>& fine, CellGrid<double>& coarse, int n)
{
    coarse.create(n);
    const int step = fine.size() / n;
    for (int r = 0; r < n; r++)
        for (int c = 0; c < n; c++)
            for (int i = 0; i < GROUP_CHANNELS; i++)
            {
                double sum = 0;
                for (int y = 0; y < step; y++)
                    for (int x = 0; x < step; x++)
                        sum += fine.cell(r * step + y, c * step + x)[i];
                coarse.cell(r, c)[i] = sum;
            }
}

template <typename T, typename Sum>
void describeBlock(const Parameters& p, const std::vector<Channel>& channels, int group, const Block& block,
        const std::vector<SupportRegion>& region, Mat& descriptors)
{
    const Size image = channels[0].map.size();
    const int largest = maxValue(channels, maxGradient(channels));
    const typename CellSumsFunc<Sum>::Type cellSums = getCellSumsFunc(Sum());
    BitEncoder bits(p, group, (int)channels.size());
    const CellEdgesFunc cellEdges = getCellEdgesFunc();
    const int n = bits.size();
    CellGrid<Sum> fine;
    const int *const xEdges = bits.xEdges(), *const yEdges = bits.yEdges();
    IntegralBand<T, Sum> band(channels, block.area, block.rows + Block::BAND_ROWS + 1);

    // Neighbours in the block may lie far apart in memory.
    std::vector<SupportRegion> local;
    local.reserve(block.keypoints.size());
    for (int k : block.keypoints)
        local.push_back(region[k]);

    const double largestSum = (Sum) ~(Sum)0;
    for (size_t i = 0; i < local.size(); i++)
    {
        uchar* descriptor = descriptors.ptr(block.keypoints[i]);
        cellEdges(local[i], n, image, bits.xEdges(), bits.yEdges());
        band.advance(block.bandEnd(std::max(yEdges[n], block.area.y)));
        const double cell = longestCell(local[i].side, n);
        if (largest * cell * cell <= largestSum)
        {
            cellSums(band.rows(), xEdges, yEdges, n, bits.finestCells<Sum>());
            bits.write<Sum>(cell, largest, descriptor);
            continue;
        }
        // Cells whose sums could exceed a Sum are put together from smaller ones.
        int parts = 2;
        while (largest * FineEdges(xEdges, yEdges, n, parts).largestCell() > largestSum)
            parts *= 2;
        const FineEdges edges(xEdges, yEdges, n, parts);
        cellSums(band.rows(), edges.x.data(), edges.y.data(), n * parts, fine);
        gather(fine, bits.finestCells<double>(), n);
        bits.write<double>(cell, largest, descriptor);
    }
}

//! Whether 16 bits hold the sums over the finest cells of all keypoints.
bool sumsAreShort(
        const Parameters& p, int largest, const Block& block, const std::vector<SupportRegion>& region)
{
    double side = 0;
    for (int k : block.keypoints)
        side = std::max(side, region[k].side);
    const double cell = longestCell(side, 1 << finestLevel(p));
    return largest * cell * cell <= USHRT_MAX;
}

}  // namespace

void describeUpright(const Parameters& p, const std::vector<Channel>& channels, int group, const Block& block,
        const std::vector<SupportRegion>& region, Mat& descriptors)
{
    if (isDeep(channels))
        describeBlock<int, unsigned>(p, channels, group, block, region, descriptors);
    else if (sumsAreShort(p, maxValue(channels, maxGradient(channels)), block, region))
        describeBlock<short, ushort>(p, channels, group, block, region, descriptors);
    else
        describeBlock<short, unsigned>(p, channels, group, block, region, descriptors);
}

}  // namespace iib
}  // namespace cv
