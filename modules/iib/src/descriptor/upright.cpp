// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#include "upright.hpp"

#include "columns.hpp"
#include "encode.hpp"

namespace cv {
namespace iib {

namespace {

//! The last rows of an integral image of a group of channels, from the top of a rectangle of the image to its bottom.
template <typename T, typename Sum> class IntegralBand
{
public:
    //! @param channels 1 to GROUP_CHANNELS; they, the kernels and the memory outlive the band.
    //! @param rows how many rows, the newest included, a reader looks at.
    IntegralBand(const std::vector<Channel>& channels, Rect area, int rows, const DescriptorKernels& all,
            ScratchMemory& rowMemory, ScratchMemory& ringMemory)
        : channelRows(channels, area, maxGradient(channels), all.pixels(T()).rows, rowMemory),
          ring(area.tl(), rows, ((size_t)area.width + 1 + ROW_PADDING) * GROUP_CHANNELS, GROUP_CHANNELS,
                  ringMemory),
          width(area.width), kernels(all.integral(T(), Sum())),
          longestPart((int)std::sqrt((double)std::numeric_limits<Sum>::max() /
                                     maxValue(channels.data(), (int)channels.size(), maxGradient(channels))))
    {
    }

    //! Adds the image's rows up to and without y, area.y <= y <= area.y + area.height.
    void advance(int y)
    {
        ring.advance(y, [&](int row, const Sum* above, Sum* out) {
            kernels.sumRow(channelRows.compute(row), width, above, out);
        });
    }

    //! Sums over n x n cells, each of which a Sum must hold.
    void cells(const CellEdges& edges, int n, CellGrid<Sum>& sums) const
    {
        kernels.cells(ring.rows(), edges.x, edges.y, n, sums);
    }

    //! Sums over larger cells: those over parts of them are added up.
    void cells(const CellEdges& edges, int n, CellGrid<double>& sums) const
    {
        sums.create(n);
        for (int r = 0; r < n; r++)
            for (int c = 0; c < n; c++)
            {
                double* const sum = sums.cell(r, c);
                std::fill_n(sum, GROUP_CHANNELS, 0.);
                for (int y = edges.y[r]; y < edges.y[r + 1]; y += longestPart)
                {
                    const Sum *const top = ring.row(y), *const bottom = ring.row(
                                                                std::min(y + longestPart, edges.y[r + 1]));
                    for (int x = edges.x[c]; x < edges.x[c + 1]; x += longestPart)
                    {
                        const size_t left = at(x), right = at(std::min(x + longestPart, edges.x[c + 1]));
                        for (int i = 0; i < GROUP_CHANNELS; i++)
                            sum[i] += (Sum)(bottom[right + i] - bottom[left + i] - top[right + i] +
                                            top[left + i]);
                    }
                }
            }
    }

private:
    size_t at(int x) const { return (size_t)(x - ring.rows().origin.x) * GROUP_CHANNELS; }

    ChannelRows<T> channelRows;
    RowRing<Sum> ring;
    const int width;
    const IntegralKernels<T, Sum>& kernels;
    const int longestPart;  //!< a Sum holds the sums over as many rows of as many pixels
};

//! By sums over cells that a Band makes.
template <typename Band, typename Sum>
void describeBatch(const DescriptorPlan& plan, const ChannelGroup& group,
        const std::vector<Channel>& channels, const KeyPointBatch& batch,
        const std::vector<SupportRegion>& regions, Workspace& workspace, Mat& descriptors)
{
    const Size image = channels[0].map.size();
    const int n = plan.cellsInRow();
    CellGrid<Sum>& cells = workspace.sumsOf(Sum(), plan.finest);
    const int largest = maxValue(channels.data(), (int)channels.size(), maxGradient(channels));
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
        const double largestSum =
                maxValue(channels.data(), (int)channels.size(), maxGradient(channels)) * pixels;
        const bool fits16Bits = largestSum <= USHRT_MAX, fits32Bits = largestSum <= UINT_MAX;
        const auto describe = !fits32Bits         ? describeBatch<IntegralBand<int, unsigned>, double>
                              : is16Bit(channels) ? describeBatch<IntegralBand<int, unsigned>, unsigned>
                              : !fits16Bits       ? describeBatch<IntegralBand<short, unsigned>, unsigned>
                              : columnsAreFaster(plan, channels, batch, side)
                                      ? describeBatch<ColumnBand, ushort>
                                      : describeBatch<IntegralBand<short, ushort>, ushort>;
        describe(plan, group, channels, batch, regions, workspace, descriptors);
    }
}

}  // namespace iib
}  // namespace cv
