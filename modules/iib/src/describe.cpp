// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#include "describe.hpp"

#include "input.hpp"
#include "upright.hpp"

namespace cv {
namespace iib {

namespace {

//! The pixels of the image that a ROS needs: at least one, so that a ROS outside the image has a place too.
Rect neededPixels(const Ros& ros, Size image)
{
    Rect r = ros.inside(image);
    r.x = std::min(r.x, image.width - 1);
    r.y = std::min(r.y, image.height - 1);
    r.width = std::max(r.width, 1);
    r.height = std::max(r.height, 1);
    return r;
}

}  // namespace

void describe(const Parameters& p, const Mat& image, const std::vector<Mat>& extra,
              const std::vector<KeyPoint>& keypoints, Mat& descriptors)
{
    std::vector<Ros> ros;
    std::vector<Rect> needed;
    for (const KeyPoint& kp : keypoints)
    {
        ros.push_back(Ros(kp, p.scaleFactor, p.granularity));
        needed.push_back(neededPixels(ros.back(), image.size()));
    }

    const Rect whole(Point(), image.size());
    std::vector<Mat> maps;
    for (const Mat& m : extra)
        maps.push_back(integerMap(m, whole));
    const std::vector<Channel> channels = channelsInUse(p, integerMap(image, whole), maps);

    descriptors = Scalar::all(0);
    const std::vector<Block> blocks = cutBlocks(needed, getNumThreads());
    parallel_for_(Range(0, (int)blocks.size()), [&](const Range& range)
    {
        for (int b = range.start; b < range.end; b++)
            for (size_t first = 0; first < channels.size(); first += GROUP_CHANNELS)
            {
                const size_t end = std::min(first + GROUP_CHANNELS, channels.size());
                const std::vector<Channel> group(channels.begin() + first, channels.begin() + end);
                describeUpright(p, group, (int)first / GROUP_CHANNELS, blocks[b], ros, descriptors);
            }
    });
}

}  // namespace iib
}  // namespace cv
