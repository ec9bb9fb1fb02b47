// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#include "compute.hpp"

#include "bands.hpp"

namespace cv {
namespace iib {

namespace {

//! By sums over cells that a Band makes.
template <typename Band, typename Sum>
void describeBatch(const DescriptorPlan& plan, const ChannelGroup& group,
        const std::vector<Channel>& channels, const KeyPointBatch& batch,
        const std::vector<SupportRegion>& regions, Workspace& workspace, Mat& descriptors)
{
    const Size image = channels[0].map.size();
    const int n = plan.cellsInRow();
    CellGrid<Sum>& cells = workspace.cellsOf(Sum());
    const int largest = maxValue(channels, maxGradient(channels));
    Band band(channels, batch.area, batch.rows + KeyPointBatch::BAND_ROWS + 1, plan.kernels,
            workspace.channelRows, workspace.ring);
    CellEdges edges;

    for (int k : batch.keypoints)
    {
        const SupportRegion region = regions[k];
        plan.kernels.cellEdges(Point2d(region.x, region.y), region.side, n,
                region.bounds(image, plan.parameters.border), edges);
        band.advance(batch.bandEnd(std::max(edges.y[n], batch.area.y)));
        band.cells(edges, n, cells);
        writeBits(plan, group, cells, edges, longestCell(region.side, n), largest, workspace,
                descriptors.ptr(k));
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
    return plan.kernels.columnCells && ofImage && n % 8 == 0 && side <= NARROW_CELL * n * 1.000001 &&
           pixelsOfKeyPoint * (double)batch.keypoints.size() <= (double)batch.area.width * batch.area.height;
}

}  // namespace

static void describeGroup(const DescriptorPlan& plan, const ChannelGroup& group,
        const std::vector<Channel>& channels, const KeyPointBatch& batch,
        const std::vector<SupportRegion>& regions, Workspace& workspace, Mat& descriptors)
{
    const double side = largestSide(batch, regions), cell = longestCell(side, plan.cellsInRow());
    const double pixels = std::min(cell * cell, (double)batch.area.width * batch.area.height);
    const double largestSum = maxValue(channels, maxGradient(channels)) * pixels;
    const bool fits16Bits = largestSum <= USHRT_MAX, fits32Bits = largestSum <= UINT_MAX;
    const bool is16 = is16Bit(channels);
    const auto describe = is16 && !fits32Bits ? describeBatch<IntegralBand<int, unsigned>, double>
                          : is16              ? describeBatch<IntegralBand<int, unsigned>, unsigned>
                          : !fits32Bits       ? describeBatch<IntegralBand<short, unsigned>, double>
                          : !fits16Bits       ? describeBatch<IntegralBand<short, unsigned>, unsigned>
                          : columnsAreFaster(plan, channels, batch, side)
                                  ? describeBatch<ColumnBand, ushort>
                                  : describeBatch<IntegralBand<short, ushort>, ushort>;
    describe(plan, group, channels, batch, regions, workspace, descriptors);
}

void describeUpright(const DescriptorPlan& plan, const std::vector<Channel>& channels,
        const KeyPointBatch& batch, const std::vector<SupportRegion>& regions, Workspace& workspace,
        Mat& descriptors)
{
    for (const ChannelGroup& group : plan.groups)
    {
        const auto first = channels.begin() + group.first;
        describeGroup(plan, group, std::vector<Channel>(first, first + group.count), batch, regions,
                workspace, descriptors);
    }
}

}  // namespace iib
}  // namespace cv
