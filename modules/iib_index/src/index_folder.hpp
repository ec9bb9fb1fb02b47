// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "code_segment.hpp"
#include "opencv2/iib/detail/checked_file.hpp"

namespace cv { namespace iib {

/* The files of an index: manifest.iib, segment-NNNNNN.iib, lock, and unfinished files, not yet renamed. */

String manifestOf(const String& folder);
String segmentOf(const String& folder, uint64 number);
String lockOf(const String& folder);

//! Makes the folder if it is missing.
void makeFolder(const String& folder);
//! Throws if the folder holds anything but a lock and unfinished files, which a killed create() leaves.
void checkEmpty(const String& folder);
//! Removes the unfinished files of an index and nothing else. Requires the lock.
void removeUnfinished(const String& folder);

/* Format 1 of a manifest, a checked file:
- u32: number of levels, each level's bytes;
- u64: number of segments; for each, number (in its file's name, ascending), rows, images, checksum;
- u64: number of removed images, and each of them in ascending order. */

//! A commit of MappedIndex: the segments in the order of their rows, and the hidden images.
struct Manifest
{
    std::vector<int> levelSizes;
    std::vector<SegmentEntry> segments;
    std::vector<uint64> removed;  //!< images, ascending
    uint64 checksum = 0;          //!< of the manifest's file
};

//! Writes a manifest beside the old one and sets its checksum. The result's commit() replaces the old one atomically.
CheckedWriter writeManifest(const String& filename, Manifest& manifest);

Manifest readManifest(const String& filename);

}}  // namespace cv::iib
