// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "opencv2/core.hpp"

namespace cv { namespace iib {

//! A file mapped into read-only memory, and read from the disk on access. The file must not be shortened meanwhile.
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

}}  // namespace cv::iib
