// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#include "encode.hpp"
#include "grid_pixels.hpp"

namespace cv { namespace iib {

namespace {

/** The maps to sample, in packs of up to GROUP_CHANNELS: first those of the image's channels, if there are any, then extra
 maps. @param channels with the image's before the extra ones. */
std::vector<std::vector<Channel>> packsOf(const std::vector<Channel>& channels)
{
    std::vector<std::vector<Channel>> packs;
    const auto end = channels.end();
    auto next = std::find_if(channels.begin(), end, [](const Channel& c) { return c.kind == 0; });
    if (next != channels.begin())
    {
        const Mat& image = channels[0].map;
        packs.push_back({{IIB::CHANNEL_SIGNED_GRAD_X, image}, {IIB::CHANNEL_SIGNED_GRAD_Y, image},
                {IIB::CHANNEL_ORIENTATION, image}, {IIB::CHANNEL_INTENSITY, image}});
    }
    for (; next != end; next += packs.back().size())
        packs.push_back(std::vector<Channel>(next, next + std::min<ptrdiff_t>(end - next, GROUP_CHANNELS)));
    return packs;
}

CellEdges equalEdges(int n, int cell)
{
    CellEdges edges;
    for (int i = 0; i < paddedEdges(n); i++)
        edges.x[i] = std::min(i, n) * cell;
    std::copy_n(edges.x, n + 1, edges.y);
    return edges;
}

//! Makes the sums over cells of one keypoint after another.
template <typename T> class CellSampler
{
public:
    explicit CellSampler(const BatchJob& job_)
        : job(job_), channels(job.channels), kernels(job.plan.kernels.pixels(T()).rotated)
    {
        const int kinds = (int)channels.size();
        for (int i = 0, maps = IMAGE_PLANES; i < kinds; i++)
            places[i] = channels[i].kind ? planeOf(channels[i].kind) : maps++;
        sums = job.workspace.planes.get<int>((size_t)(IMAGE_PLANES + kinds + GROUP_CHANNELS) * MAX_SAMPLES);
    }

    //! Makes all planes of sums. @param angle of the grid's rotation, in degrees.
    void sum(const GridPixels<T>& points, const std::vector<std::vector<Channel>>& packs,
            const SampleGrid& grid, const Rotation& rotation, float angle)
    {
        const int steps = cvRound(std::fmod(angle, 360.f) * ORIENTATION_STEPS / 360);
        const GradientRotation gradients = {
                cvRound(rotation.cosine * 4096), cvRound(rotation.sine * 4096), steps};
        int* planes[IMAGE_PLANES];
        int next = IMAGE_PLANES;
        for (size_t i = 0; i < packs.size(); i++)
        {
            const bool image = packs[i][0].kind != 0;
            for (int p = 0; p < (image ? (int)IMAGE_PLANES : GROUP_CHANNELS); p++)
                planes[p] = plane(image ? p : next++);
            if (image)
                kernels.imageSums(points.pixels(i), points.indices(), grid.cells(), grid.sub * grid.sub,
                        gradients, planes);
            else
                kernels.mapSums(
                        points.pixels(i), points.indices(), grid.cells(), grid.sub * grid.sub, planes);
        }
    }

    //! Writes the bits of all groups of channels.
    void write(const SampleGrid& grid, uchar* descriptor)
    {
        const DescriptorPlan& plan = job.plan;
        const int n = plan.cellsInRow(), cell = grid.n / n;
        const CellEdges edges = equalEdges(n, cell);
        const auto parentSums = plan.kernels.longBits.parentSums;
        for (const ChannelGroup& group : plan.groups)
        {
            CellGrid<unsigned>* cells[2] = {&job.workspace.samples, &job.workspace.sums[plan.finest]};
            const int largest = interleave(group, grid, *cells[0]);
            for (; cells[0]->size() > n; std::swap(cells[0], cells[1]))
                parentSums(*cells[0], *cells[1]);
            const LevelWriter writer = {job, group, edges, 4. * largest, descriptor};
            writer.writeFitting(plan.finest, *cells[0], cell);
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
            planes[i] = plane(places[c]);
            const int kind = channels[c].kind;
            const bool isSigned = kind == IIB::CHANNEL_SIGNED_GRAD_X || kind == IIB::CHANNEL_SIGNED_GRAD_Y;
            // a component is at most 4 times the largest pixel, and rotated at most sqrt(2) times that
            const int largest = 6 * maxPixel(channels[c].map.depth());
            addends[i] = isSigned ? largest * grid.sub * grid.sub : 0;
            if (usesGradient(channels[c]))
                gradient = largest;
        }
        kernels.interleave(planes, addends, grid.cells(), cells);
        return maxValue(&channels[group.first], group.count, gradient);
    }

    const BatchJob& job;
    const std::vector<Channel>& channels;
    const RotatedSampleKernels<T>& kernels;
    int places[IMAGE_PLANES + MAX_EXTRA_CHANNELS];  //!< plane of each channel
    int* sums;
};

template <typename T> void describeBatch(const BatchJob& job)
{
    const DescriptorPlan& plan = job.plan;
    const Parameters& p = plan.parameters;
    const std::vector<std::vector<Channel>> packs = packsOf(job.channels);
    CellSampler<T> sampler(job);
    GridPixels<T> pixels(plan.kernels, packs, job.batch, job.workspace);
    for (int k : job.batch.keypoints)
    {
        const SupportRegion& region = job.regions[k];
        const Rotation rotation(region.angle);
        const int n = region.side <= 64 && p.granularity <= 5 ? 32 : 64;
        // Two by two samples a cell, unless the cells are fewer.
        const int sub = plan.cellsInRow() == n ? 1 : 2;
        const SampleGrid grid = gridOf(region, rotation, n, sub, p.border, job.grey.size());
        pixels.moveTo(job.pixels[k], grid);
        sampler.sum(pixels, packs, grid, rotation, region.angle);
        sampler.write(grid, job.descriptors.ptr(k));
    }
}

}  // namespace

void describeRotated(const BatchJob& job)
{
    (is16Bit(job.channels) ? describeBatch<int> : describeBatch<short>)(job);
}

}}  // namespace cv::iib
