// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#pragma once

#include "opencv2/core.hpp"

#include <cstdio>

namespace cv {
namespace iib {

/** A file that takes the place of another when it is whole: written beside it, flushed to the disk, renamed.

Until commit(), and if anything fails, the old file stays as it is; who reads meanwhile gets the old one or the new
one. What a symbolic link points to is replaced, not the link. A target that is no regular file, a device or a pipe, is
written directly. */
class ReplacedFile
{
public:
    explicit ReplacedFile(const String& filename);
    //! Removes what was written unless it was committed.
    ~ReplacedFile();
    ReplacedFile(const ReplacedFile&) = delete;
    ReplacedFile& operator=(const ReplacedFile&) = delete;

    void write(const void* data, size_t size);
    //! Throws if any write failed.
    void commit();

private:
    void open();

    String name;       //!< as given, for errors
    String target;     //!< with links resolved
    String temporary;  //!< empty if the target is written directly
    std::FILE* stream;
};

}  // namespace iib
}  // namespace cv
