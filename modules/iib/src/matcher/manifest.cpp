// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#include "../precomp.hpp"
#include "manifest.hpp"
#include "../common/checked_file.hpp"

namespace cv {
namespace iib {

static const FileKind KIND = {"IIBSHARD", 1, "the manifest of a MappedIndex"};

void writeManifest(const String& filename, const Manifest& manifest)
{
    CheckedWriter file(filename, KIND);
    file.number(manifest.levelSizes.size(), 4);
    for (size_t i = 0; i < manifest.levelSizes.size(); i++)
        file.number(manifest.levelSizes[i], 4);
    file.number(manifest.segments.size(), 8);
    for (size_t i = 0; i < manifest.segments.size(); i++)
    {
        const SegmentEntry& segment = manifest.segments[i];
        for (uint64 value : {segment.number, segment.rows, segment.images, segment.checksum})
            file.number(value, 8);
    }
    file.number(manifest.removed.size(), 8);
    for (size_t i = 0; i < manifest.removed.size(); i++)
        file.number(manifest.removed[i], 8);
    file.seal();
    file.commit();
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
    return manifest;
}

}  // namespace iib
}  // namespace cv
