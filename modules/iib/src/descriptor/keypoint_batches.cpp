// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#include "keypoint_batches.hpp"

namespace cv { namespace iib {

namespace {

typedef std::vector<int> Indices;

Range extent(const Rect& r, bool vertical)
{
    return vertical ? Range(r.y, r.y + r.height) : Range(r.x, r.x + r.width);
}

//! Splits at gaps along one axis. Linear in the keypoints and in the axis.
std::vector<Indices> splitAtGaps(const std::vector<Rect>& regions, const Indices& keypoints, bool vertical)
{
    Range all(INT_MAX, INT_MIN);
    for (int k : keypoints)
    {
        const Range e = extent(regions[k], vertical);
        all.start = std::min(all.start, e.start);
        all.end = std::max(all.end, e.end);
    }
    std::vector<int> part(
            all.size() + 1, 0);  // regions that begin here less those that end, then the part's number
    for (int k : keypoints)
    {
        const Range e = extent(regions[k], vertical);
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
        pieces[part[extent(regions[k], vertical).start - all.start]].push_back(k);
    pieces.erase(std::remove_if(pieces.begin(), pieces.end(), [](const Indices& p) { return p.empty(); }),
            pieces.end());
    return pieces;
}

//! Splits along both axes in turn until there is no gap left, or MAX_CUTS times.
std::vector<Indices> splitInRounds(const std::vector<Rect>& regions, const Indices& keypoints)
{
    std::vector<Indices> parts(1, keypoints);
    bool lastSplit = true;  // whether the round before split any part
    for (int round = 0; round < MAX_CUTS; round++)
    {
        std::vector<Indices> next;
        for (const Indices& part : parts)
            for (Indices& piece : splitAtGaps(regions, part, round % 2 == 0))
                next.push_back(std::move(piece));
        const bool split = next.size() > parts.size();
        parts.swap(next);
        if (!split && !lastSplit)
            break;
        lastSplit = split;
    }
    return parts;
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

Rect unionOf(const std::vector<Rect>& regions, const Indices& keypoints)
{
    Rect all = regions[keypoints[0]];
    for (int k : keypoints)
        all |= regions[k];
    return all;
}

//! Cuts keypoints into strips of equal size across the longer side of their area.
void cutStrips(const std::vector<Rect>& regions, const Indices& keypoints, Rect area, int strips,
        std::vector<Indices>& batches)
{
    const bool vertical = area.height > area.width;
    const Range whole = extent(area, vertical);
    std::vector<Indices> parts(strips);
    for (int k : keypoints)
    {
        const Range e = extent(regions[k], vertical);
        const int centre = e.start + e.size() / 2 - whole.start;
        parts[(int)((int64)centre * strips / whole.size())].push_back(k);
    }
    for (const Indices& part : parts)
        if (!part.empty())
            batches.push_back(part);
}

}  // namespace

std::vector<Indices> cutBatches(const std::vector<Rect>& regions, const Indices& keypoints, int workers)
{
    if (keypoints.empty())
        return std::vector<Indices>();
    const std::vector<Indices> parts = splitInRounds(regions, keypoints);
    std::vector<Indices> batches;

    std::vector<Rect> areas;
    double pixels = 0;
    for (const Indices& part : parts)
    {
        areas.push_back(unionOf(regions, part));
        pixels += (double)areas.back().width * areas.back().height;
    }
    for (size_t i = 0; i < parts.size(); i++)
    {
        const double share = (double)areas[i].width * areas[i].height / pixels;
        cutStrips(regions, parts[i], areas[i], std::max(cvRound(share * workers), 1), batches);
    }
    return batches;
}

KeyPointBatch makeBatch(const std::vector<Rect>& regions, const Indices& keypoints)
{
    KeyPointBatch batch = {unionOf(regions, keypoints), 0, keypoints};
    for (int k : keypoints)
        batch.rows = std::max(batch.rows, regions[k].height);
    countingSort(batch.keypoints, batch.area.width, [&](int k) { return regions[k].x - batch.area.x; });
    countingSort(batch.keypoints, batch.area.height / KeyPointBatch::BAND_ROWS + 2, [&](int k) {
        return (regions[k].br().y - batch.area.y + KeyPointBatch::BAND_ROWS - 1) / KeyPointBatch::BAND_ROWS;
    });
    return batch;
}

}}  // namespace cv::iib
