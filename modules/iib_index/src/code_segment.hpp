// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "opencv2/iib/detail/packed_codes.hpp"

#include <mutex>

namespace cv { namespace iib {

/* Format 2 of a segment, a checked file:
- u32: number of levels, each level's bytes, layout, number of blocks of PackedCodes per checksum;
- u64: number of images, each image's rows, the checksums (FNV-1a of little-endian 64-bit words), the hash;
- zeros up to a multiple of 4096 bytes, then the blocks of PackedCodes. */

//! A segment's entry in the manifest.
struct SegmentEntry
{
    uint64 number, rows, images, checksum;  //!< checksum: the hash in the file
};

//! Writes codes to a file, which appears only when it is complete and on the disk.
SegmentEntry writeSegment(
        const String& filename, uint64 number, const std::vector<int>& levels, const PackedCodes& codes);

//! A file mapped into read-only memory (mapped_file.cpp), and read from the disk on access. The file must not be shortened meanwhile.
class MappedFile
{
public:
    explicit MappedFile(const String& filename);
    ~MappedFile();
    MappedFile(const MappedFile&) = delete;
    MappedFile& operator=(const MappedFile&) = delete;

    const uchar* data() const { return bytes; }
    size_t size() const { return length; }

private:
    const uchar* bytes;
    size_t length;
};

//! A segment's file, mapped and checked on first use.
class CodeSegment
{
public:
    CodeSegment(const String& filename, const SegmentEntry& entry, const std::vector<int>& levelSizes);
    const SegmentEntry& entry() const { return expected; }
    //! @throws cv::Exception that names the file if it is missing, altered, or not the file of the entry.
    const PackedCodes& codes();

private:
    void map();

    const String name;
    const SegmentEntry expected;
    const std::vector<int> levels;
    std::mutex lock;
    Ptr<MappedFile> file;
    Ptr<PackedCodes> packed;  // null until the file is checked
};

}}  // namespace cv::iib
