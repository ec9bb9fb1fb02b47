// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#include "keypoint_batches.hpp"

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
std::vector<Indices> splitAtGaps(const std::vector<Rect>& region, const Indices& keypoints, bool vertical)
{
    Range all(INT_MAX, INT_MIN);
    for (int k : keypoints)
    {
        const Range e = extent(region[k], vertical);
        all.start = std::min(all.start, e.start);
        all.end = std::max(all.end, e.end);
    }
    std::vector<int> part(all.size() + 1, 0);  // first what begins less what ends here, then which part it is
    for (int k : keypoints)
    {
        const Range e = extent(region[k], vertical);
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
    if (parts == 1)
        return std::vector<Indices>(1, keypoints);
    std::vector<Indices> pieces(parts);
    for (int k : keypoints)
        pieces[part[extent(region[k], vertical).start - all.start]].push_back(k);
    pieces.erase(std::remove_if(pieces.begin(), pieces.end(), [](const Indices& p) { return p.empty(); }),
            pieces.end());
    return pieces;
}

//! Splits along both axes in turn until there is no gap left.
void splitRecursively(const std::vector<Rect>& region, const Indices& keypoints, bool vertical,
        bool otherAxisSplit, std::vector<Indices>& parts)
{
    const std::vector<Indices> pieces = splitAtGaps(region, keypoints, vertical);
    if (pieces.size() == 1 && !otherAxisSplit)
    {
        parts.push_back(keypoints);
        return;
    }
    for (const Indices& piece : pieces)
        splitRecursively(region, piece, !vertical, pieces.size() > 1, parts);
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

Rect unionOf(const std::vector<Rect>& region, const Indices& keypoints)
{
    Point begin = region[keypoints[0]].tl(), end = region[keypoints[0]].br();
    for (int k : keypoints)
    {
        const Rect& r = region[k];
        begin = Point(std::min(begin.x, r.x), std::min(begin.y, r.y));
        end = Point(std::max(end.x, r.x + r.width), std::max(end.y, r.y + r.height));
    }
    return Rect(begin, end);
}

//! Cuts a block across its longer side, where fewer support region are cut, into parts of equal area, by the centres of the support region.
void cutStrips(const std::vector<Rect>& region, const Indices& keypoints, Rect area, int strips,
        std::vector<Indices>& blocks)
{
    if (strips == 1)
    {
        blocks.push_back(keypoints);
        return;
    }
    const bool vertical = area.height > area.width;
    const Range whole = extent(area, vertical);
    std::vector<Indices> parts(strips);
    for (int k : keypoints)
    {
        const Range e = extent(region[k], vertical);
        const int centre = e.start + e.size() / 2 - whole.start;
        parts[(int)((int64)centre * strips / whole.size())].push_back(k);
    }
    for (const Indices& part : parts)
        if (!part.empty())
            blocks.push_back(part);
}

}  // namespace

std::vector<Indices> cutBlocks(const std::vector<Rect>& region, int workers)
{
    if (region.empty())
        return std::vector<Indices>();
    Indices all(region.size());
    std::iota(all.begin(), all.end(), 0);
    std::vector<Indices> parts, blocks;
    splitRecursively(region, all, true, true, parts);

    std::vector<Rect> areas;
    double pixels = 0;
    for (const Indices& part : parts)
    {
        areas.push_back(unionOf(region, part));
        pixels += (double)areas.back().width * areas.back().height;
    }
    for (size_t i = 0; i < parts.size(); i++)
    {
        const double share = (double)areas[i].width * areas[i].height / pixels;
        cutStrips(region, parts[i], areas[i], std::max(cvRound(share * workers), 1), blocks);
    }
    return blocks;
}

Block makeBlock(const std::vector<Rect>& region, const Indices& keypoints)
{
    Block block = {unionOf(region, keypoints), 0, keypoints};
    for (int k : keypoints)
        block.rows = std::max(block.rows, region[k].height);
    countingSort(block.keypoints, block.area.width, [&](int k) { return region[k].x - block.area.x; });
    countingSort(block.keypoints, block.area.height / Block::BAND_ROWS + 2, [&](int k) {
        return (region[k].br().y - block.area.y + Block::BAND_ROWS - 1) / Block::BAND_ROWS;
    });
    return block;
}

}  // namespace iib
}  // namespace cv
