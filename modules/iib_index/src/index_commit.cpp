// SPDX-License-Identifier: Apache-2.0
#include "precomp.hpp"
#include "index_commit.hpp"
#include "index_folder.hpp"

namespace cv {
namespace iib {

void checkNumber(int64 number, uint64 count, const char* what)
{
    if (number < 0 || (uint64)number >= count)
        CV_Error_(
                Error::StsOutOfRange, ("%s %lld: there are %lld", what, (long long)number, (long long)count));
}

// The last segment that begins at or before a number; `firsts` ends with the number of all.
static size_t segmentHolding(int64 number, const std::vector<size_t>& firsts, const char* what)
{
    checkNumber(number, firsts.back(), what);
    return std::upper_bound(firsts.begin(), firsts.end(), (size_t)number) - firsts.begin() - 1;
}

IndexCommit::IndexCommit(const String& folder, const Manifest& manifest, const IndexCommit* before)
    : committed(manifest), firstRows(1, 0), firstImages(1, 0)
{
    SearchedCodes::check(manifest.levelSizes);
    const size_t known = before ? before->opened.size() : 0;
    for (size_t i = 0; i < manifest.segments.size(); i++)
    {
        const SegmentEntry& entry = manifest.segments[i];
        const bool same = i < known && before->opened[i]->entry().number == entry.number &&
                          before->opened[i]->entry().checksum == entry.checksum;
        opened.push_back(
                same ? before->opened[i]
                     : makePtr<CodeSegment>(segmentOf(folder, entry.number), entry, manifest.levelSizes));
        firstRows.push_back(firstRows.back() + (size_t)entry.rows);
        firstImages.push_back(firstImages.back() + (size_t)entry.images);
    }
}

int64 IndexCommit::imageOf(int64 row) const
{
    const size_t i = segmentHolding(row, firstRows, "row");
    return (int64)(firstImages[i] + opened[i]->codes().imageOf((size_t)row - firstRows[i]));
}

int64 IndexCommit::firstRow(int64 image) const
{
    const size_t i = segmentHolding(image, firstImages, "image");
    return (int64)(firstRows[i] + opened[i]->codes().start((size_t)image - firstImages[i]));
}

Mat IndexCommit::descriptors(int64 image) const
{
    const size_t i = segmentHolding(image, firstImages, "image");
    return opened[i]->codes().descriptors((size_t)image - firstImages[i]);
}

SearchedCodes::Part IndexCommit::part(int segment) const
{
    // First: a manifest may claim more images than memory has bits for.
    const SearchedCodes& codes = opened[segment]->codes();
    const std::vector<uint64>& removed = committed.removed;
    const auto first = std::lower_bound(removed.begin(), removed.end(), firstImages[segment]),
               end = std::lower_bound(first, removed.end(), firstImages[segment + 1]);
    std::vector<bool> hidden(first == end ? 0 : firstImages[segment + 1] - firstImages[segment], false);
    for (auto image = first; image != end; ++image)
        hidden[(size_t)*image - firstImages[segment]] = true;
    return {&codes, firstRows[segment], hidden};
}

}  // namespace iib
}  // namespace cv
