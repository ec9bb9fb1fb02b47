// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#include "rotated.hpp"

#include "cell_sampler.hpp"
#include "gradient_orientation.hpp"
#include "grid_pixels.hpp"

namespace cv {
namespace iib {

namespace {

int samplesInRow(const SupportRegion& region, int granularity)
{
    return region.side <= 64 && granularity <= 5 ? 32 : 64;
}

//! The angle of a region by its own gradients.
template <typename T>
float angleOf(GridPixels<T>& pixels, const DescriptorKernels& kernels, const SupportRegion& region,
        Point2f centre, int rank, int border, Size image)
{
    const SampleGrid grid = gridOf(
            region, centre, Rotation(0), ORIENTATION_CELLS * ORIENTATION_SUB, ORIENTATION_SUB, border, image);
    const typename GridPixels<T>::Points points = pixels.at(region, centre, grid);
    return prevailingAngle(kernels, points.pixels(0), points.index(), rank);
}

template <typename T>
void describeBatch(const DescriptorPlan& plan, const std::vector<Channel>& channels,
        const KeyPointBatch& batch, const std::vector<SupportRegion>& regions,
        const std::vector<KeyPoint>& keypoints, const std::vector<int>& ranks, Workspace& workspace,
        Mat& descriptors)
{
    const Parameters& p = plan.parameters;
    const Size image = channels[0].map.size();
    CellSampler<T> sampler(plan, channels, workspace);
    GridPixels<T> pixels(plan.kernels, sampler.packs(), batch, p.border, workspace);
    for (int k : batch.keypoints)
    {
        const SupportRegion& region = regions[k];
        const Point2f centre = keypoints[k].pt;
        const Rotation rotation(
                p.orientation == IIB::ORIENTATION_GRADIENT
                        ? angleOf(pixels, plan.kernels, region, centre, ranks[k], p.border, image)
                        : keypoints[k].angle);
        const int n = samplesInRow(region, p.granularity);
        // Two by two samples a cell, unless the cells are fewer.
        const int sub = plan.cellsInRow() == n ? 1 : 2;
        const SampleGrid grid = gridOf(region, centre, rotation, n, sub, p.border, image);
        sampler.sum(pixels.at(region, centre, grid), grid, rotation);
        sampler.write(grid, descriptors.ptr(k));
    }
}

template <typename T>
void findAngles(const DescriptorPlan& plan, const Mat& image, const KeyPointBatch& batch,
        const std::vector<SupportRegion>& regions, const std::vector<KeyPoint>& keypoints,
        const std::vector<int>& ranks, Workspace& workspace, std::vector<float>& angles)
{
    const SampledChannels sampled({Channel{IIB::CHANNEL_INTENSITY, image}});
    GridPixels<T> pixels(plan.kernels, sampled.packs, batch, plan.parameters.border, workspace);
    for (int k : batch.keypoints)
        angles[k] = angleOf(pixels, plan.kernels, regions[k], keypoints[k].pt, ranks[k],
                plan.parameters.border, image.size());
}

}  // namespace

void describeRotated(const DescriptorPlan& plan, const std::vector<Channel>& channels,
        const KeyPointBatch& batch, const std::vector<SupportRegion>& regions,
        const std::vector<KeyPoint>& keypoints, const std::vector<int>& ranks, Workspace& workspace,
        Mat& descriptors)
{
    if (is16Bit(channels))
        describeBatch<int>(plan, channels, batch, regions, keypoints, ranks, workspace, descriptors);
    else
        describeBatch<short>(plan, channels, batch, regions, keypoints, ranks, workspace, descriptors);
}

void prevailingAngles(const DescriptorPlan& plan, const Mat& image, const KeyPointBatch& batch,
        const std::vector<SupportRegion>& regions, const std::vector<KeyPoint>& keypoints,
        const std::vector<int>& ranks, Workspace& workspace, std::vector<float>& angles)
{
    if (image.depth() == CV_16U)
        findAngles<int>(plan, image, batch, regions, keypoints, ranks, workspace, angles);
    else
        findAngles<short>(plan, image, batch, regions, keypoints, ranks, workspace, angles);
}

}  // namespace iib
}  // namespace cv
