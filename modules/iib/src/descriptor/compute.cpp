// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#include "compute.hpp"

#include "input.hpp"
#include "rotated.hpp"
#include "upright.hpp"

namespace cv {
namespace iib {

namespace {

typedef std::vector<int> Indices;

//! Keypoints and the pixels that they need.
struct Part
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

    //! A block whose keypoints are indices of the whole image's.
    Block block(const Indices& part) const
    {
        Block b = makeBlock(pixels, part);
        for (int& k : b.keypoints)
            k = keypoints[k];
        return b;
    }
};

void describeUprightBlock(const Parameters& p, const std::vector<Channel>& channels, const Block& block,
        const std::vector<SupportRegion>& region, Mat& descriptors)
{
    for (size_t first = 0; first < channels.size(); first += GROUP_CHANNELS)
    {
        const size_t end = std::min(first + GROUP_CHANNELS, channels.size());
        const std::vector<Channel> group(channels.begin() + first, channels.begin() + end);
        describeUpright(p, group, (int)first / GROUP_CHANNELS, block, region, descriptors);
    }
}

}  // namespace

void describe(const Parameters& p, const Mat& image, const std::vector<Mat>& extra,
        const std::vector<KeyPoint>& keypoints, Mat& descriptors)
{
    std::vector<SupportRegion> region;
    region.reserve(keypoints.size());
    Part upright, turned;
    upright.reserve(keypoints.size());
    for (const KeyPoint& kp : keypoints)
    {
        const int k = (int)region.size();
        region.push_back(SupportRegion(kp, p.scaleFactor, p.granularity));
        if (p.useOrientation && kp.angle >= 0)
            turned.add(k, turnedPixels(region[k], kp, image.size()));
        else
            upright.add(k, region[k].pixels(image.size()));
    }

    const Rect whole(Point(), image.size());
    std::vector<Mat> maps;
    for (const Mat& m : extra)
        maps.push_back(integerMap(m, whole));
    const std::vector<Channel> channels = channelsInUse(p, integerMap(image, whole), maps);

    const std::vector<Indices> uprightParts = cutBlocks(upright.pixels, getNumThreads());
    const std::vector<Indices> turnedParts = cutBlocks(turned.pixels, getNumThreads());
    const int uprightCount = (int)uprightParts.size();
    parallel_for_(Range(0, uprightCount + (int)turnedParts.size()), [&](const Range& range) {
        for (int b = range.start; b < range.end; b++)
            if (b < uprightCount)
                describeUprightBlock(p, channels, upright.block(uprightParts[b]), region, descriptors);
            else
                describeTurned(p, channels, turned.block(turnedParts[b - uprightCount]), region, keypoints,
                        descriptors);
    });
}

}  // namespace iib
}  // namespace cv
