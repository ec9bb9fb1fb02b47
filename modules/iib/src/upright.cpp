// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#include "upright.hpp"

#include "integral.hpp"
#include "keypoint_bits.hpp"

namespace cv {
namespace iib {

namespace {

//! The edges of n x n cells of a ROS.
struct Edges
{
    std::vector<int> x, y;

    void place(const Ros& ros, int n, Size image)
    {
        x.resize(n + 1);
        y.resize(n + 1);
        for (int k = 0; k <= n; k++)
        {
            x[k] = ros.edge(ros.x, k, n, image.width);
            y[k] = ros.edge(ros.y, k, n, image.height);
        }
    }

    double largestCell() const { return (double)largestStep(x) * largestStep(y); }

private:
    static int largestStep(const std::vector<int>& edges)
    {
        int largest = 0;
        for (size_t i = 1; i < edges.size(); i++)
            largest = std::max(largest, edges[i] - edges[i - 1]);
        return largest;
    }
};

//! Sums of a grid from those of a finer one.
void gather(const CellGrid<int>& fine, CellGrid<double>& coarse, int n)
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
                        sum += (unsigned)fine.cell(r * step + y, c * step + x)[i];
                coarse.cell(r, c)[i] = sum;
            }
}

template <typename Lane, typename Sum>
void describeBlock(const Parameters& p, const std::vector<Channel>& channels, int group, const Block& block,
                   const std::vector<Ros>& ros, Mat& descriptors)
{
    const Size image = channels[0].map.size();
    const int largest = maxValue(channels, maxGradient(channels));
    const typename CellSumsFunc<Sum>::Type cellSums = getCellSumsFunc(Sum());
    KeyPointBits bits(p, group, (int)channels.size());
    const int n = bits.size();
    CellGrid<int> scratch, fine;
    Edges edges, fineEdges;

    int rows = 0;
    for (int k : block.keypoints)
        rows = std::max(rows, ros[k].pixels(image).height + 1);
    IntegralBand<Lane, Sum> band(channels, block.area, rows);

    for (int k : block.keypoints)
    {
        edges.place(ros[k], n, image);
        band.advance(std::max(edges.y[n], block.area.y));

        // Cells whose sums could exceed a Sum are put together from smaller ones.
        int fineSize = n;
        fineEdges.x.clear();
        while (largest * (fineSize == n ? edges : fineEdges).largestCell() > (Sum)~(Sum)0)
            fineEdges.place(ros[k], fineSize *= 2, image);
        if (fineSize == n)
            cellSums(band.rows(), edges.x.data(), edges.y.data(), n, scratch, bits.finestCells());
        else
        {
            cellSums(band.rows(), fineEdges.x.data(), fineEdges.y.data(), fineSize, scratch, fine);
            gather(fine, bits.finestWideCells(), n);
        }
        bits.write(edges.x.data(), edges.y.data(), largest, fineSize != n, descriptors.ptr(k));
    }
}

//! Whether 16 bits hold the sums over the finest cells of all keypoints.
bool sumsAreShort(const Parameters& p, int largest, const Block& block, const std::vector<Ros>& ros)
{
    double side = 0;
    for (int k : block.keypoints)
        side = std::max(side, ros[k].side);
    const double cell = std::ceil(side / (1 << p.granularity));
    return largest * cell * cell <= USHRT_MAX;
}

}  // namespace

void describeUpright(const Parameters& p, const std::vector<Channel>& channels, int group, const Block& block,
                     const std::vector<Ros>& ros, Mat& descriptors)
{
    if (isDeep(channels))
        describeBlock<int, unsigned>(p, channels, group, block, ros, descriptors);
    else if (sumsAreShort(p, maxValue(channels, maxGradient(channels)), block, ros))
        describeBlock<short, ushort>(p, channels, group, block, ros, descriptors);
    else
        describeBlock<short, unsigned>(p, channels, group, block, ros, descriptors);
}

}  // namespace iib
}  // namespace cv
