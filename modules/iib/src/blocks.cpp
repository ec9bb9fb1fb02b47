// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#include "blocks.hpp"

#include <numeric>

namespace cv {
namespace iib {

namespace {

typedef std::vector<int> Indices;

Range extent(const Rect& r, bool vertical)
{
    return vertical ? Range(r.y, r.y + r.height) : Range(r.x, r.x + r.width);
}

//! Splits at gaps along one axis.
std::vector<Indices> splitAtGaps(const std::vector<Rect>& ros, Indices keypoints, bool vertical)
{
    std::sort(keypoints.begin(), keypoints.end(), [&](int a, int b)
    {
        return extent(ros[a], vertical).start < extent(ros[b], vertical).start;
    });
    std::vector<Indices> parts;
    int end = INT_MIN;
    for (int k : keypoints)
    {
        const Range e = extent(ros[k], vertical);
        if (e.start > end)
            parts.push_back(Indices());
        parts.back().push_back(k);
        end = std::max(end, e.end);
    }
    return parts;
}

//! Splits along both axes in turn until there is no gap left.
void splitRecursively(const std::vector<Rect>& ros, const Indices& keypoints, bool vertical, bool otherAxisSplit,
                      std::vector<Indices>& parts)
{
    const std::vector<Indices> pieces = splitAtGaps(ros, keypoints, vertical);
    if (pieces.size() == 1 && !otherAxisSplit)
    {
        parts.push_back(keypoints);
        return;
    }
    for (const Indices& piece : pieces)
        splitRecursively(ros, piece, !vertical, pieces.size() > 1, parts);
}

Block makeBlock(const std::vector<Rect>& ros, Indices keypoints)
{
    std::sort(keypoints.begin(), keypoints.end(), [&](int a, int b)
    {
        return ros[a].br().y != ros[b].br().y ? ros[a].br().y < ros[b].br().y : ros[a].x < ros[b].x;
    });
    Block block;
    block.area = ros[keypoints[0]];
    for (int k : keypoints)
        block.area |= ros[k];
    block.keypoints = keypoints;
    return block;
}

//! Cuts a block into strips of equal height, by the centres of the ROS.
void cutStrips(const std::vector<Rect>& ros, const Block& block, int strips, std::vector<Block>& blocks)
{
    std::vector<Indices> parts(strips);
    for (int k : block.keypoints)
    {
        const int y = ros[k].y + ros[k].height / 2 - block.area.y;
        parts[(int)((int64)y * strips / block.area.height)].push_back(k);
    }
    for (const Indices& part : parts)
        if (!part.empty())
            blocks.push_back(makeBlock(ros, part));
}

}  // namespace

std::vector<Block> cutBlocks(const std::vector<Rect>& ros, int workers)
{
    if (ros.empty())
        return std::vector<Block>();
    Indices all(ros.size());
    std::iota(all.begin(), all.end(), 0);
    std::vector<Indices> parts;
    splitRecursively(ros, all, true, true, parts);

    std::vector<Block> whole;
    double pixels = 0;
    for (const Indices& part : parts)
    {
        whole.push_back(makeBlock(ros, part));
        pixels += (double)whole.back().area.width * whole.back().area.height;
    }
    std::vector<Block> blocks;
    for (const Block& block : whole)
        cutStrips(ros, block, std::max(cvRound((double)block.area.width * block.area.height * workers / pixels), 1), blocks);
    return blocks;
}

}  // namespace iib
}  // namespace cv
