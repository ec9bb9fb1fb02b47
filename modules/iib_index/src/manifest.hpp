// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "code_segment.hpp"
#include "opencv2/iib/detail/checked_file.hpp"

namespace cv {
namespace iib {

/* Format 1 of a manifest, a checked file: u32: number of levels, each level's bytes; u64: number of segments; of each:
number (of its file's name, ascending), rows, images, checksum; number of removed images, each of them in ascending order. */

//! What a commit of MappedIndex holds: the segments in the order of their rows, and which images are hidden.
struct Manifest
{
    std::vector<int> levelSizes;
    std::vector<SegmentEntry> segments;
    std::vector<uint64> removed;  //!< images, ascending
    uint64 checksum = 0;          //!< of the file that it was read from
};

//! Writes a manifest beside the old one, which commit() replaces in one step, and fills in its checksum.
CheckedWriter writeManifest(const String& filename, Manifest& manifest);

Manifest readManifest(const String& filename);

}  // namespace iib
}  // namespace cv
