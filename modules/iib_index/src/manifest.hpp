// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "code_segment.hpp"
#include "opencv2/iib/checked_file.private.hpp"

namespace cv {
namespace iib {

/* Format 1 of a manifest, a checked file: u32: number of levels, each level's bytes; u64: number of segments; of each:
number (of its file's name, ascending), rows, images, checksum; number of removed images, each of them in ascending order. */

//! What a commit of MappedIndex holds: the segments in the order of their rows, and which images are hidden.
struct Manifest
{
    Manifest() : checksum(0) {}
    std::vector<int> levelSizes;
    std::vector<SegmentEntry> segments;
    std::vector<uint64> removed;  //!< images, ascending
    uint64 checksum;              //!< of the file that it was read from
};

//! A manifest that is written beside the old one.
class ManifestFile
{
public:
    //! Fills in the manifest's checksum.
    ManifestFile(const String& filename, Manifest& manifest);
    //! Replaces the old one in one step.
    void commit() { file.commit(); }

private:
    CheckedWriter file;
};

Manifest readManifest(const String& filename);

}  // namespace iib
}  // namespace cv
