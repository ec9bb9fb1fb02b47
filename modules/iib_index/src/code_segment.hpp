// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "mapped_file.hpp"
#include "opencv2/iib/detail/packed_codes.hpp"

#include <mutex>

namespace cv {
namespace iib {

/* Format 2 of a segment, a checked file: u32: number of levels, each level's bytes, layout, checked blocks: blocks of
PackedCodes that a checksum is for; u64: number of images, each image's rows, a checksum for each of the checked blocks; the
hash. Then zeros up to a multiple of 4096 bytes, and from there the blocks of PackedCodes. Checksums are FNV-1a of
little-endian words of 64 bits. */

//! What the manifest says of a segment.
struct SegmentEntry
{
    uint64 number, rows, images, checksum;  //!< checksum: the hash in the file
};

//! Writes codes to a file, which appears when it is whole and on the disk.
SegmentEntry writeSegment(
        const String& filename, uint64 number, const std::vector<int>& levels, const PackedCodes& codes);

//! A segment's file, mapped and checked when its codes are first asked for.
class CodeSegment
{
public:
    CodeSegment(const String& filename, const SegmentEntry& entry, const std::vector<int>& levelSizes);
    const SegmentEntry& entry() const { return expected; }
    //! @throws cv::Exception that names the file if it is missing, altered, or not the one that the entry tells of.
    const PackedCodes& codes();

private:
    void map();

    const String name;
    const SegmentEntry expected;
    const std::vector<int> levels;
    std::mutex lock;
    Ptr<MappedFile> file;
    Ptr<PackedCodes> packed;  // null until it is checked
};

}  // namespace iib
}  // namespace cv
