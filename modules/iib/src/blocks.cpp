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

//! Splits at gaps along one axis. Linear in the keypoints and in the axis.
std::vector<Indices> splitAtGaps(const std::vector<Rect>& ros, const Indices& keypoints, bool vertical)
{
    Range all(INT_MAX, INT_MIN);
    for (int k : keypoints)
    {
        const Range e = extent(ros[k], vertical);
        all.start = std::min(all.start, e.start);
        all.end = std::max(all.end, e.end);
    }
    std::vector<int> part(all.size() + 1, 0);  // first what begins less what ends here, then which part it is
    for (int k : keypoints)
    {
        const Range e = extent(ros[k], vertical);
        part[e.start - all.start]++;
        part[e.end - all.start]--;
    }
    int open = 0, parts = 0;
    for (int& p : part)
    {
        open += p;
        p = parts;
        parts += open == 0;
    }
    std::vector<Indices> pieces(parts);
    for (int k : keypoints)
        pieces[part[extent(ros[k], vertical).start - all.start]].push_back(k);
    pieces.erase(std::remove_if(pieces.begin(), pieces.end(), [](const Indices& p) { return p.empty(); }),
                 pieces.end());
    return pieces;
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

//! Stable, linear sort of indices by keys in [0, keyCount).
template <typename Key> void countingSort(Indices& indices, int keyCount, const Key& key)
{
    std::vector<int> place(keyCount + 1, 0);
    for (int i : indices)
        place[key(i) + 1]++;
    for (int k = 0; k < keyCount; k++)
        place[k + 1] += place[k];
    Indices sorted(indices.size());
    for (int i : indices)
        sorted[place[key(i)]++] = i;
    indices.swap(sorted);
}

Block makeBlock(const std::vector<Rect>& ros, const Indices& keypoints)
{
    Block block = { ros[keypoints[0]], 0, keypoints };
    for (int k : keypoints)
    {
        block.area |= ros[k];
        block.rows = std::max(block.rows, ros[k].height);
    }
    countingSort(block.keypoints, block.area.width, [&](int k) { return ros[k].x - block.area.x; });
    countingSort(block.keypoints, block.area.height / Block::BAND_ROWS + 2, [&](int k)
    {
        return (ros[k].br().y - block.area.y + Block::BAND_ROWS - 1) / Block::BAND_ROWS;
    });
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
