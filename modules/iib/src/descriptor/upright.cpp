// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#include "steps.hpp"

#include "bands.hpp"
#include "encode.hpp"

namespace cv {
namespace iib {

namespace {

//! Whether sums down the columns take less time than integral images: where cells are narrow, and keypoints are few.
bool columnsAreFaster(const DescriptorPlan& plan, const std::vector<Channel>& channels, bool ofImage,
        const KeyPointBatch& batch, double side)
{
    const double pixelsOfKeyPoint = 256;  // so many make up for the longer time that a keypoint's cells take
    for (const Channel& c : channels)
        ofImage = ofImage && c.kind != 0;
    const int n = plan.cellsInRow();
    // 7 * (64.f / 7), the region of FAST's keypoints, is a little more than 64
    return plan.kernels.columnCells && ofImage && n % 8 == 0 && side <= NARROW_CELL * n * 1.000001 &&
           pixelsOfKeyPoint * (double)batch.keypoints.size() <= (double)batch.area.width * batch.area.height;
}

//! By sums over cells that a Band makes.
template <typename Band, typename Sum>
void describeBatch(const DescriptorPlan& plan, const ChannelGroup& group,
        const std::vector<Channel>& channels, const ChannelBounds& bounds, const KeyPointBatch& batch,
        const std::vector<SupportRegion>& regions, Workspace& workspace, Mat& descriptors)
{
    const Size image = channels[0].map.size();
    const int n = plan.cellsInRow();
    CellGrid<Sum>& cells = workspace.sumsOf(Sum(), plan.finest);
    Band band(channels, bounds, batch.area, batch.rows + KeyPointBatch::BAND_ROWS + 1, plan.kernels,
            workspace.channelRows, workspace.ring);
    CellEdges edges;

    for (int k : batch.keypoints)
    {
        const SupportRegion region = regions[k];
        plan.kernels.cellEdges(Point2d(region.x, region.y), region.side, n,
                region.bounds(image, plan.parameters.border), edges);
        band.advance(batch.bandEnd(std::max(edges.y[n], batch.area.y)));
        band.cells(edges, n, cells);
        writeBits(plan, group, cells, edges, longestCell(region.side, n), bounds.value, workspace,
                descriptors.ptr(k));
    }
}

}  // namespace

void describeUpright(const DescriptorPlan& plan, const std::vector<Channel>& allChannels,
        const KeyPointBatch& batch, const std::vector<SupportRegion>& regions, Workspace& workspace,
        Mat& descriptors)
{
    double side = 0;
    for (int k : batch.keypoints)
        side = std::max(side, regions[k].side);
    const double cell = longestCell(side, plan.cellsInRow());
    const double pixels = std::min(cell * cell, (double)batch.area.width * batch.area.height);
    for (const ChannelGroup& group : plan.groups)
    {
        const auto first = allChannels.begin() + group.first;
        const std::vector<Channel> channels(first, first + group.count);
        const ChannelBounds bounds(channels);
        const double largestSum = bounds.value * pixels;
        const bool fits16Bits = largestSum <= USHRT_MAX, fits32Bits = largestSum <= UINT_MAX;
        const auto describe = !fits32Bits         ? describeBatch<IntegralBand<int, unsigned>, double>
                              : is16Bit(channels) ? describeBatch<IntegralBand<int, unsigned>, unsigned>
                              : !fits16Bits       ? describeBatch<IntegralBand<short, unsigned>, unsigned>
                              : columnsAreFaster(plan, channels, bounds.gradient > 0, batch, side)
                                      ? describeBatch<ColumnBand, ushort>
                                      : describeBatch<IntegralBand<short, ushort>, ushort>;
        describe(plan, group, channels, bounds, batch, regions, workspace, descriptors);
    }
}

}  // namespace iib
}  // namespace cv
