// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#ifndef OPENCV_IIB_DESCRIPTOR_CELL_SAMPLER_HPP
#define OPENCV_IIB_DESCRIPTOR_CELL_SAMPLER_HPP

#include "bit_encoder.hpp"
#include "channels.hpp"
#include "rotation.hpp"
#include "workspace.hpp"

namespace cv {
namespace iib {

/** What the channels of a descriptor are sampled from, GROUP_CHANNELS values to a pixel: what the image's channels are
 made of comes first, extra maps follow. */
struct SampledChannels
{
    bool hasImage;
    std::vector<std::vector<Channel>> packs;
    std::vector<int> planeOf;  //!< of each channel, in the planes of sums

    explicit SampledChannels(const std::vector<Channel>& channels) : hasImage(false)
    {
        std::vector<Channel> maps;
        for (const Channel& c : channels)
        {
            int plane = 0;
            while (c.kind >> plane > 1)
                plane++;
            planeOf.push_back(c.kind == 0 ? -1 - (int)maps.size() : plane);
            if (c.kind == 0)
                maps.push_back(c);
            else if (!hasImage)
            {
                hasImage = true;
                const int kinds[] = {IIB::CHANNEL_SIGNED_GRAD_X, IIB::CHANNEL_SIGNED_GRAD_Y,
                        IIB::CHANNEL_ORIENTATION, IIB::CHANNEL_INTENSITY};
                packs.push_back(std::vector<Channel>());
                for (int kind : kinds)
                    packs[0].push_back(Channel{kind, c.map});
            }
        }
        for (int& plane : planeOf)
            if (plane < 0)
                plane = imagePlanes() - 1 - plane;
        for (size_t i = 0; i < maps.size(); i += GROUP_CHANNELS)
            packs.push_back(std::vector<Channel>(
                    maps.begin() + i, maps.begin() + std::min(i + GROUP_CHANNELS, maps.size())));
    }

    int imagePlanes() const { return hasImage ? IMAGE_PLANES : 0; }
    int planes() const { return imagePlanes() + GROUP_CHANNELS * ((int)packs.size() - hasImage); }
};

//! Both components of a gradient are 4 times the largest pixel at most; rotated, one is sqrt(2) times that at most.
inline int maxRotatedGradient(int depth) { return 6 * maxPixel(depth); }

//! Edges of n x n cells of the same size.
inline CellEdges equalEdges(int n, int cell)
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
        : plan(plan_), channels(channels_), sampled(channels_), workspace(workspace_),
          kernels(plan_.kernels.pixels(T()).rotated),
          sums(workspace_.planes.get<int>((size_t)sampled.planes() * MAX_SAMPLES))
    {
    }

    const std::vector<std::vector<Channel>>& packs() const { return sampled.packs; }

    //! Makes all planes of sums. @param points of the grid: GridPixels::Points.
    template <typename Points>
    void sum(const Points& points, const SampleGrid& grid, const Rotation& rotation)
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
                kernels.imageSums(points.pixels(i), points.index(), grid.cells(), grid.sub * grid.sub,
                        gradients, planes);
            else
                kernels.mapSums(points.pixels(i), points.index(), grid.cells(), grid.sub * grid.sub, planes);
        }
    }

    //! Writes the bits of all groups of channels.
    void write(const SampleGrid& grid, uchar* descriptor)
    {
        const int n = plan.cellsInRow(), cell = grid.n / n;
        const CellEdges edges = equalEdges(n, cell);
        const auto parentSums = plan.kernels.longSums.bits[plan.parameters.mapping].parentSums;
        for (const ChannelGroup& group : plan.groups)
        {
            CellGrid<unsigned>* cells[2] = {&workspace.cells, &workspace.parentCells};
            const int largest = interleave(group, grid, *cells[0]);
            for (; cells[0]->size() > n; std::swap(cells[0], cells[1]))
                parentSums(*cells[0], *cells[1]);
            BitEncoder(plan, group, largest, workspace.encoder).write(*cells[0], edges, cell, descriptor);
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

}  // namespace iib
}  // namespace cv

#endif
