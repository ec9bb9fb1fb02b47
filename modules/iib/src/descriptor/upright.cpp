// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#include "bands.hpp"
#include "encode.hpp"

namespace cv { namespace iib {

namespace {

//! Whether sums down the columns are faster than integral images: for narrow cells and few keypoints.
bool columnsAreFaster(const BatchJob& job, const std::vector<Channel>& channels, bool ofImage, double side)
{
    const double pixelsOfKeyPoint =
            256;  // the extra time for a keypoint's cells, in pixels of an integral image
    for (const Channel& c : channels)
        ofImage = ofImage && c.kind != 0;
    const int n = job.plan.cellsInRow();
    const Rect area = job.batch.area;
    // 1.000001: the region of FAST's keypoints, 7 * (64.f / 7), is a little more than 64
    return job.plan.kernels.columnCells && ofImage && n % 8 == 0 && side <= NARROW_CELL * n * 1.000001 &&
           pixelsOfKeyPoint * (double)job.batch.keypoints.size() <= (double)area.width * area.height;
}

//! Describes the keypoints for a group of channels. A Band makes the sums over cells.
template <typename Band, typename Sum>
void describeBatch(const BatchJob& job, const ChannelGroup& group, const std::vector<Channel>& channels,
        const ChannelBounds& bounds)
{
    const DescriptorPlan& plan = job.plan;
    const KeyPointBatch& batch = job.batch;
    const int n = plan.cellsInRow();
    CellGrid<Sum>& cells = job.workspace.sumsOf(Sum(), plan.finest);
    Band band(channels, bounds, batch.area, batch.rows + KeyPointBatch::BAND_ROWS + 1, plan.kernels,
            job.workspace.channelRows, job.workspace.ring);
    CellEdges edges;

    for (int k : batch.keypoints)
    {
        const SupportRegion region = job.regions[k];
        plan.kernels.cellEdges(Point2d(region.x, region.y), region.side, n,
                region.bounds(job.grey.size(), plan.parameters.border), edges);
        band.advance(batch.bandEnd(std::max(edges.y[n], batch.area.y)));
        band.cells(edges, n, cells);
        const LevelWriter writer = {job, group, edges, 4. * bounds.value, job.descriptors.ptr(k)};
        writer.writeFitting(plan.finest, cells, std::ceil(region.side / n));
    }
}

}  // namespace

void describeUpright(const BatchJob& job)
{
    double side = 0;
    for (int k : job.batch.keypoints)
        side = std::max(side, job.regions[k].side);
    const double cell = std::ceil(side / job.plan.cellsInRow());  // no cell is longer
    const double pixels = std::min(cell * cell, (double)job.batch.area.width * job.batch.area.height);
    for (const ChannelGroup& group : job.plan.groups)
    {
        const auto first = job.channels.begin() + group.first;
        const std::vector<Channel> channels(first, first + group.count);
        const ChannelBounds bounds(channels);
        const double largestSum = bounds.value * pixels;
        const bool fits16Bits = largestSum <= USHRT_MAX, fits32Bits = largestSum <= UINT_MAX;
        const bool ofBytes = !is16Bit(channels);
        // whose pixels and sums fit its types
        const auto fastest =
                ofBytes && fits16Bits && columnsAreFaster(job, channels, bounds.gradient > 0, side)
                        ? describeBatch<ColumnBand, ushort>
                : ofBytes && fits16Bits ? describeBatch<IntegralBand<short, ushort>, ushort>
                : ofBytes && fits32Bits ? describeBatch<IntegralBand<short, unsigned>, unsigned>
                : fits32Bits            ? describeBatch<IntegralBand<int, unsigned>, unsigned>
                                        : describeBatch<IntegralBand<int, unsigned>, double>;
        fastest(job, group, channels, bounds);
    }
}

}}  // namespace cv::iib
