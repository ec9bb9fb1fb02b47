// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#include "compute.hpp"

#include "grid_pixels.hpp"

namespace cv {
namespace iib {

namespace {

/** What the channels of a descriptor are sampled from, GROUP_CHANNELS values to a pixel: what the image's channels are
 made of comes first, extra maps follow. */
struct SampledChannels
{
    bool hasImage;
    std::vector<std::vector<Channel>> packs;
    std::vector<int> planeOf;  //!< of each channel, in the planes of sums
    int planes;
};

//! The place of a single IIB::Channel among them.
int planeOfKind(int kind)
{
    int plane = 0;
    while (kind >> plane > 1)
        plane++;
    return plane;
}

//! @param channels of the image, if any, before the extra ones.
SampledChannels sampledChannels(const std::vector<Channel>& channels)
{
    SampledChannels s = {channels[0].kind != 0, {}, {}, 0};
    if (s.hasImage)
    {
        s.planes = IMAGE_PLANES;
        const Mat& image = channels[0].map;
        s.packs.push_back({{IIB::CHANNEL_SIGNED_GRAD_X, image}, {IIB::CHANNEL_SIGNED_GRAD_Y, image},
                {IIB::CHANNEL_ORIENTATION, image}, {IIB::CHANNEL_INTENSITY, image}});
    }
    int maps = 0;
    for (const Channel& c : channels)
        if (c.kind != 0)
            s.planeOf.push_back(planeOfKind(c.kind));
        else
        {
            if (maps++ % GROUP_CHANNELS == 0)
            {
                s.packs.push_back(std::vector<Channel>());
                s.planes += GROUP_CHANNELS;
            }
            s.packs.back().push_back(c);
            s.planeOf.push_back((s.hasImage ? IMAGE_PLANES : 0) + maps - 1);
        }
    return s;
}

//! Both components of a gradient are 4 times the largest pixel at most; rotated, one is sqrt(2) times that at most.
int maxRotatedGradient(int depth) { return 6 * maxPixel(depth); }

//! Edges of n x n cells of the same size.
CellEdges equalEdges(int n, int cell)
{
    CellEdges edges;
    for (int i = 0; i < paddedEdges(n); i++)
        edges.x[i] = std::min(i, n) * cell;
    std::copy_n(edges.x, n + 1, edges.y);
    return edges;
}

//! The sums over cells of one keypoint after another.
template <typename T> class CellSampler
{
public:
    CellSampler(const DescriptorPlan& plan_, const std::vector<Channel>& channels_, Workspace& workspace_)
        : plan(plan_), channels(channels_), sampled(sampledChannels(channels_)), workspace(workspace_),
          kernels(plan_.kernels.pixels(T()).rotated),
          sums(workspace_.planes.get<int>((size_t)sampled.planes * MAX_SAMPLES))
    {
    }

    const std::vector<std::vector<Channel>>& packs() const { return sampled.packs; }

    //! All planes of sums. @param points of the grid.
    void sum(GridPixels<T>& points, const SampleGrid& grid, const Rotation& rotation)
    {
        const GradientRotation gradients = {
                cvRound(rotation.cosine * 4096), cvRound(rotation.sine * 4096), rotation.steps};
        int* planes[IMAGE_PLANES];
        int next = 0;
        for (size_t i = 0; i < packs().size(); i++)
        {
            const bool image = sampled.hasImage && i == 0;
            const int count = image ? IMAGE_PLANES : GROUP_CHANNELS;
            for (int p = 0; p < count; p++)
                planes[p] = plane(next++);
            if (image)
                kernels.imageSums(points.pixels(i), points.indices(), grid.cells(), grid.sub * grid.sub,
                        gradients, planes);
            else
                kernels.mapSums(
                        points.pixels(i), points.indices(), grid.cells(), grid.sub * grid.sub, planes);
        }
    }

    //! The bits of all groups of channels.
    void write(const SampleGrid& grid, uchar* descriptor)
    {
        const int n = plan.cellsInRow(), cell = grid.n / n;
        const CellEdges edges = equalEdges(n, cell);
        const auto parentSums = plan.kernels.longBits.parentSums;
        for (const ChannelGroup& group : plan.groups)
        {
            CellGrid<unsigned>* cells[2] = {&workspace.cells, &workspace.parentCells};
            const int largest = interleave(group, grid, *cells[0]);
            for (; cells[0]->size() > n; std::swap(cells[0], cells[1]))
                parentSums(*cells[0], *cells[1]);
            writeBits(plan, group, *cells[0], edges, cell, largest, workspace, descriptor);
        }
    }

private:
    int* plane(int i) { return sums + (size_t)i * MAX_SAMPLES; }

    //! @return the largest value of the group's channels.
    int interleave(const ChannelGroup& group, const SampleGrid& grid, CellGrid<unsigned>& cells)
    {
        const int* planes[GROUP_CHANNELS];
        int addends[GROUP_CHANNELS], gradient = 0;
        for (int i = 0; i < GROUP_CHANNELS; i++)
        {
            const int c = group.first + std::min(i, group.count - 1);
            planes[i] = plane(sampled.planeOf[c]);
            const int kind = channels[c].kind;
            const bool isSigned = kind == IIB::CHANNEL_SIGNED_GRAD_X || kind == IIB::CHANNEL_SIGNED_GRAD_Y;
            const int largest = maxRotatedGradient(channels[c].map.depth());
            addends[i] = isSigned ? largest * grid.sub * grid.sub : 0;
            if (usesGradient(channels[c]))
                gradient = largest;
        }
        kernels.interleave(planes, addends, grid.cells(), cells);
        return maxValue(&channels[group.first], group.count, gradient);
    }

    const DescriptorPlan& plan;
    const std::vector<Channel>& channels;
    const SampledChannels sampled;
    Workspace& workspace;
    const RotatedSampleKernels<T>& kernels;
    int* const sums;
};

int samplesInRow(const SupportRegion& region, int granularity)
{
    return region.side <= 64 && granularity <= 5 ? 32 : 64;
}

template <typename T>
void describeBatch(const DescriptorPlan& plan, const std::vector<Channel>& channels,
        const KeyPointBatch& batch, const std::vector<SupportRegion>& regions, Workspace& workspace,
        Mat& descriptors)
{
    const Parameters& p = plan.parameters;
    const Size image = channels[0].map.size();
    CellSampler<T> sampler(plan, channels, workspace);
    GridPixels<T> pixels(plan.kernels, sampler.packs(), batch, p.border, workspace);
    for (int k : batch.keypoints)
    {
        const SupportRegion& region = regions[k];
        const Rotation rotation(region.angle);
        const int n = samplesInRow(region, p.granularity);
        // Two by two samples a cell, unless the cells are fewer.
        const int sub = plan.cellsInRow() == n ? 1 : 2;
        const SampleGrid grid = gridOf(region, rotation, n, sub, p.border, image);
        pixels.moveTo(region, grid);
        sampler.sum(pixels, grid, rotation);
        sampler.write(grid, descriptors.ptr(k));
    }
}

}  // namespace

void describeRotated(const DescriptorPlan& plan, const std::vector<Channel>& channels,
        const KeyPointBatch& batch, const std::vector<SupportRegion>& regions, Workspace& workspace,
        Mat& descriptors)
{
    const auto describe = is16Bit(channels) ? describeBatch<int> : describeBatch<short>;
    describe(plan, channels, batch, regions, workspace, descriptors);
}

}  // namespace iib
}  // namespace cv
