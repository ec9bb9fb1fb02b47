// SPDX-License-Identifier: Apache-2.0

#include "precomp.hpp"
#include "manifest.hpp"

namespace cv { namespace iib {

static const FileKind KIND = {"IIBSHARD", 1, "the manifest of a MappedIndex"};

CheckedWriter writeManifest(const String& filename, Manifest& manifest)
{
    CheckedWriter file(filename, KIND);
    file.list(manifest.levelSizes, 4);
    file.number(manifest.segments.size(), 8);
    for (const SegmentEntry& segment : manifest.segments)
        for (uint64 value : {segment.number, segment.rows, segment.images, segment.checksum})
            file.number(value, 8);
    file.list(manifest.removed, 8);
    manifest.checksum = file.seal();
    return file;
}

// Checks the invariants of a commit; sums of its numbers cannot overflow then.
static bool isConsistent(const Manifest& manifest)
{
    const uint64 limit = (uint64)1 << INDEX_BITS;
    uint64 rows = 0, images = 0, last = 0;
    for (const SegmentEntry& segment : manifest.segments)
    {
        if (segment.number <= last || segment.rows >= limit - rows || segment.images >= limit - images)
            return false;
        last = segment.number;
        rows += segment.rows;
        images += segment.images;
    }
    for (size_t i = 0; i < manifest.removed.size(); i++)
        if (manifest.removed[i] >= images || (i > 0 && manifest.removed[i] <= manifest.removed[i - 1]))
            return false;
    return true;
}

Manifest readManifest(const String& filename)
{
    CheckedReader file(filename, KIND);
    Manifest manifest;
    manifest.levelSizes = file.list<int>(4);
    const uint64 segments = file.number(8);
    file.expect(segments, 4 * 8);
    for (uint64 i = 0; i < segments; i++)
    {
        SegmentEntry segment;
        for (uint64* value : {&segment.number, &segment.rows, &segment.images, &segment.checksum})
            *value = file.number(8);
        manifest.segments.push_back(segment);
    }
    manifest.removed = file.list<uint64>(8);
    manifest.checksum = file.seal();
    file.expectEnd();
    if (!isConsistent(manifest))
        file.fail("the numbers of its segments and images are inconsistent");
    return manifest;
}

}}  // namespace cv::iib
