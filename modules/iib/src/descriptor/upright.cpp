// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#include "upright.hpp"

#include "column_band.hpp"
#include "integral_band.hpp"

namespace cv {
namespace iib {

namespace {

/* Edges that cut each cell of another grid into parts x parts. They are made of pixels of the image, not of the region,
 which may be so much larger that any number of its parts is needed to cut the image once. */
struct FineEdges
{
    std::vector<int> x, y;

    FineEdges(const CellEdges& edges, int n, int parts)
        : x(split(edges.x, n, parts)), y(split(edges.y, n, parts))
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

template <typename Sum> CellGrid<Sum>& cellsOf(Workspace& workspace);
template <> CellGrid<ushort>& cellsOf(Workspace& workspace) { return workspace.shortCells; }
template <> CellGrid<unsigned>& cellsOf(Workspace& workspace) { return workspace.cells; }

//! Cells whose sums could exceed a Sum are put together from smaller ones.
template <typename Sum, typename Band>
const CellGrid<double>& largeCellSums(
        const Band& band, const CellEdges& edges, int n, double largestPixel, Workspace& workspace)
{
    const double largestSum = std::numeric_limits<Sum>::max();
    int parts = 2;
    while (largestPixel * FineEdges(edges, n, parts).largestCell() > largestSum)
        parts *= 2;
    const FineEdges fine(edges, n, parts);
    CellGrid<Sum>& fineCells = cellsOf<Sum>(workspace);
    band.cells(fine.x.data(), fine.y.data(), n * parts, fineCells);
    gather(fineCells, workspace.doubleCells, n);
    return workspace.doubleCells;
}

//! By sums over rows and columns that a Band makes.
template <typename Band, typename Sum>
void describeBatch(const DescriptorPlan& plan, const ChannelGroup& group,
        const std::vector<Channel>& channels, const KeyPointBatch& batch,
        const std::vector<SupportRegion>& regions, Workspace& workspace, Mat& descriptors)
{
    const Size image = channels[0].map.size();
    const int n = plan.cellsInRow(), largest = maxValue(channels, maxGradient(channels));
    const double largestSum = std::numeric_limits<Sum>::max();
    CellGrid<Sum>& cells = cellsOf<Sum>(workspace);
    const BitEncoder encoder(plan, group, largest, workspace.encoder);
    Band band(channels, batch.area, batch.rows + KeyPointBatch::BAND_ROWS + 1, plan.kernels,
            workspace.channelRows, workspace.ring);
    CellEdges edges;

    for (int k : batch.keypoints)
    {
        const SupportRegion region = regions[k];
        uchar* descriptor = descriptors.ptr(k);
        plan.kernels.cellEdges(Point2d(region.x, region.y), region.side, n,
                region.bounds(image, plan.parameters.border), edges);
        band.advance(batch.bandEnd(std::max(edges.y[n], batch.area.y)));
        const double cell = longestCell(region.side, n);
        if (largest * cell * cell <= largestSum)
        {
            band.cells(edges.x, edges.y, n, cells);
            encoder.write(cells, edges, cell, descriptor);
        }
        else
            encoder.write(largeCellSums<Sum>(band, edges, n, largest, workspace), edges, cell, descriptor);
    }
}

double largestSide(const KeyPointBatch& batch, const std::vector<SupportRegion>& regions)
{
    double side = 0;
    for (int k : batch.keypoints)
        side = std::max(side, regions[k].side);
    return side;
}

//! Whether sums down the columns take less time than integral images: where cells are narrow, and keypoints are few.
bool columnsAreFaster(const DescriptorPlan& plan, const std::vector<Channel>& channels,
        const KeyPointBatch& batch, double side)
{
    const double pixelsOfKeyPoint = 256;  // so many make up for the longer time that a keypoint's cells take
    bool ofImage = maxGradient(channels) > 0;
    for (const Channel& c : channels)
        ofImage = ofImage && c.kind != 0;
    const int n = plan.cellsInRow();
    // 7 * (64.f / 7), the region of FAST's keypoints, is a little more than 64
    return plan.kernels.columnCells && ofImage && n % 8 == 0 && side <= ColumnRows::CELL * n * 1.000001 &&
           pixelsOfKeyPoint * (double)batch.keypoints.size() <= (double)batch.area.width * batch.area.height;
}

}  // namespace

void describeUpright(const DescriptorPlan& plan, const ChannelGroup& group,
        const std::vector<Channel>& channels, const KeyPointBatch& batch,
        const std::vector<SupportRegion>& regions, Workspace& workspace, Mat& descriptors)
{
    const double side = largestSide(batch, regions), cell = longestCell(side, plan.cellsInRow());
    // whether 16 bits hold the sums over the finest cells of all keypoints
    const bool isShort = maxValue(channels, maxGradient(channels)) * cell * cell <= USHRT_MAX;
    const auto describe = is16Bit(channels) ? describeBatch<IntegralBand<int, unsigned>, unsigned>
                          : !isShort        ? describeBatch<IntegralBand<short, unsigned>, unsigned>
                          : columnsAreFaster(plan, channels, batch, side)
                                  ? describeBatch<ColumnBand, ushort>
                                  : describeBatch<IntegralBand<short, ushort>, ushort>;
    describe(plan, group, channels, batch, regions, workspace, descriptors);
}

}  // namespace iib
}  // namespace cv
