// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#include "compute.hpp"

#include <array>
#include <map>

#include "../common/image_input.hpp"
#include "boxes.hpp"
#include "rotated.hpp"
#include "rotated_region.hpp"
#include "upright.hpp"

namespace cv {
namespace iib {

namespace {

typedef std::vector<int> Indices;

//! Keypoints that are described in the same way, and the pixels that they need.
struct Subset
{
    Indices keypoints;
    std::vector<Rect> pixels;

    void reserve(size_t n)
    {
        keypoints.reserve(n);
        pixels.reserve(n);
    }

    void add(int keypoint, Rect r)
    {
        keypoints.push_back(keypoint);
        pixels.push_back(r);
    }

    //! A batch whose keypoints are indices of the whole image's.
    KeyPointBatch batch(const Indices& members) const { return ofImage(makeBatch(pixels, members)); }

    //! The same, of one with indices of the subset.
    KeyPointBatch ofImage(KeyPointBatch b) const
    {
        for (int& k : b.keypoints)
            k = keypoints[k];
        return b;
    }
};

bool isRotated(const Parameters& p, const KeyPoint& keypoint)
{
    if (p.orientation == IIB::ORIENTATION_GRADIENT)
        return p.channels != 0;
    return p.orientation == IIB::ORIENTATION_KEYPOINT && keypoint.angle >= 0;
}

//! The channels of an image, all of them and in groups.
struct ImageChannels
{
    std::vector<Channel> all;
    std::vector<std::vector<Channel>> groups;

    ImageChannels(const DescriptorPlan& plan, const Mat& image, const std::vector<Mat>& extra)
    {
        const Rect whole(Point(), image.size());
        std::vector<Mat> maps;
        for (const Mat& m : extra)
            maps.push_back(integerMap(m, whole));
        all = channelsInUse(plan.parameters, integerMap(image, whole), maps);
        for (const ChannelGroup& g : plan.groups)
            groups.push_back(std::vector<Channel>(all.begin() + g.first, all.begin() + g.first + g.count));
    }
};

//! How many earlier keypoints have the same position and size.
std::vector<int> ranksOf(const std::vector<KeyPoint>& keypoints)
{
    std::map<std::array<float, 3>, int> seen;
    std::vector<int> ranks;
    ranks.reserve(keypoints.size());
    for (const KeyPoint& kp : keypoints)
        ranks.push_back(seen[{{kp.pt.x, kp.pt.y, kp.size}}]++);
    return ranks;
}

//! Calls work(batch, workspace) in parallel for each batch of keypoints with these pixels.
template <typename Work> void forEachBatch(const std::vector<Rect>& pixels, const Work& work)
{
    const std::vector<Indices> batches = cutBatches(pixels, getNumThreads());
    WorkspacePool pool;
    parallel_for_(Range(0, (int)batches.size()), [&](const Range& range) {
        std::unique_ptr<Workspace> workspace = pool.borrow();
        for (int b = range.start; b < range.end; b++)
            work(makeBatch(pixels, batches[b]), *workspace);
        pool.giveBack(std::move(workspace));
    });
}

//! By MAPPING_BOXES.
void describeByBoxes(const DescriptorPlan& plan, const Mat& image, const std::vector<SupportRegion>& regions,
        const std::vector<KeyPoint>& keypoints, Mat& descriptors)
{
    const Parameters& p = plan.parameters;
    std::vector<float> angles;
    for (const KeyPoint& kp : keypoints)
        angles.push_back(isRotated(p, kp) ? kp.angle : -1);
    std::vector<Rect> pixels;
    if (p.orientation == IIB::ORIENTATION_GRADIENT)
    {
        for (size_t k = 0; k < keypoints.size(); k++)
            pixels.push_back(rotatedPixels(regions[k], keypoints[k].pt, p.border, image.size()));
        const std::vector<int> ranks = ranksOf(keypoints);
        forEachBatch(pixels, [&](const KeyPointBatch& batch, Workspace& workspace) {
            prevailingAngles(plan, image, batch, regions, keypoints, ranks, workspace, angles);
        });
        pixels.clear();
    }
    Subset subsets[2];  // upright, rotated
    for (size_t k = 0; k < keypoints.size(); k++)
    {
        const bool rotated = angles[k] >= 0;
        subsets[rotated].add((int)k, boxPixels(regions[k], keypoints[k].pt, rotated, p.border, image.size()));
    }
    for (int rotated = 0; rotated < 2; rotated++)
        forEachBatch(subsets[rotated].pixels, [&](const KeyPointBatch& batch, Workspace& workspace) {
            describeBoxes(plan, image, subsets[rotated].ofImage(batch), regions, keypoints,
                    rotated ? &angles : 0, workspace, descriptors);
        });
}

}  // namespace

bool isInside(const DescriptorPlan& plan, const KeyPoint& keypoint, Size image)
{
    const Parameters& p = plan.parameters;
    const SupportRegion region(keypoint, p.scaleFactor, p.granularity);
    if (!isRotated(p, keypoint))
        return region.isInside(image);
    // an angle that is not known yet may be the one that reaches farthest
    const float angle = p.orientation == IIB::ORIENTATION_GRADIENT ? 45.f : keypoint.angle;
    return rotatedIsInside(region, keypoint.pt, angle, image);
}

void describe(const DescriptorPlan& plan, const Mat& image, const std::vector<Mat>& extra,
        const std::vector<KeyPoint>& keypoints, Mat& descriptors)
{
    const Parameters& p = plan.parameters;
    std::vector<SupportRegion> regions;
    regions.reserve(keypoints.size());
    for (const KeyPoint& kp : keypoints)
        regions.push_back(SupportRegion(kp, p.scaleFactor, p.granularity));
    if (plan.boxes)
        return describeByBoxes(
                plan, integerMap(image, Rect(Point(), image.size())), regions, keypoints, descriptors);
    Subset upright, rotated;
    upright.reserve(keypoints.size());
    for (int k = 0; k < (int)keypoints.size(); k++)
    {
        const KeyPoint& kp = keypoints[k];
        if (isRotated(p, kp))
            rotated.add(k, rotatedPixels(regions[k], kp.pt, p.border, image.size()));
        else
            upright.add(k, regions[k].pixels(regions[k].bounds(image.size(), p.border)));
    }

    const std::vector<int> ranks =
            p.orientation == IIB::ORIENTATION_GRADIENT ? ranksOf(keypoints) : std::vector<int>();
    const ImageChannels channels(plan, image, extra);
    const std::vector<Indices> uprightBatches = cutBatches(upright.pixels, getNumThreads());
    const std::vector<Indices> rotatedBatches = cutBatches(rotated.pixels, getNumThreads());
    const int uprightCount = (int)uprightBatches.size();
    WorkspacePool pool;
    parallel_for_(Range(0, uprightCount + (int)rotatedBatches.size()), [&](const Range& range) {
        std::unique_ptr<Workspace> workspace = pool.borrow();
        for (int b = range.start; b < range.end; b++)
            if (b < uprightCount)
            {
                const KeyPointBatch batch = upright.batch(uprightBatches[b]);
                for (size_t g = 0; g < plan.groups.size(); g++)
                    describeUpright(plan, plan.groups[g], channels.groups[g], batch, regions, *workspace,
                            descriptors);
            }
            else
                describeRotated(plan, channels.all, rotated.batch(rotatedBatches[b - uprightCount]), regions,
                        keypoints, ranks, *workspace, descriptors);
        pool.giveBack(std::move(workspace));
    });
}

}  // namespace iib
}  // namespace cv
