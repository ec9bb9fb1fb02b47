// SPDX-License-Identifier: Apache-2.0

#include "precomp.hpp"
#include "manifest.hpp"

namespace cv {
namespace iib {

static const FileKind KIND = {"IIBSHARD", 1, "the manifest of a MappedIndex"};

CheckedWriter writeManifest(const String& filename, Manifest& manifest)
{
    CheckedWriter file(filename, KIND);
    file.number(manifest.levelSizes.size(), 4);
    for (int size : manifest.levelSizes)
        file.number(size, 4);
    file.number(manifest.segments.size(), 8);
    for (const SegmentEntry& segment : manifest.segments)
        for (uint64 value : {segment.number, segment.rows, segment.images, segment.checksum})
            file.number(value, 8);
    file.number(manifest.removed.size(), 8);
    for (uint64 image : manifest.removed)
        file.number(image, 8);
    manifest.checksum = file.seal();
    return file;
}

// What every commit keeps to, whose numbers are added up without a further look.
static bool fits(const Manifest& manifest)
{
    const uint64 limit = (uint64)1 << SearchedCodes::ROW_BITS;
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
    const unsigned levels = file.word();
    file.expect(levels, 4);
    for (unsigned i = 0; i < levels; i++)
        manifest.levelSizes.push_back((int)file.word());
    const uint64 segments = file.number(8);
    file.expect(segments, 4 * 8);
    for (uint64 i = 0; i < segments; i++)
    {
        SegmentEntry segment;
        for (uint64* value : {&segment.number, &segment.rows, &segment.images, &segment.checksum})
            *value = file.number(8);
        manifest.segments.push_back(segment);
    }
    const uint64 removed = file.number(8);
    file.expect(removed, 8);
    for (uint64 i = 0; i < removed; i++)
        manifest.removed.push_back(file.number(8));
    manifest.checksum = file.seal();
    file.expectEnd();
    if (!fits(manifest))
        file.fail("its segments and images do not fit together");
    return manifest;
}

}  // namespace iib
}  // namespace cv
