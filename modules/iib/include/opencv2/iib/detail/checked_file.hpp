// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#ifndef OPENCV_IIB_DETAIL_CHECKED_FILE_HPP
#define OPENCV_IIB_DETAIL_CHECKED_FILE_HPP

#include "opencv2/iib/detail/files.hpp"

#include <fstream>

namespace cv { namespace iib {

//! @cond IGNORED

/* Portable binary files with a checksum, for this library and for iib_index: eight letters that name the kind of file,
u32 version, little-endian numbers and bytes, u64 FNV-1a hash of everything before it. */

//! The 64-bit FNV-1a hash of a sequence of bytes.
class Fnv1a
{
public:
    Fnv1a() : state(CV_BIG_UINT(0xcbf29ce484222325)) {}
    void add(const void* data, size_t size)
    {
        for (size_t i = 0; i < size; i++)
            state = (state ^ static_cast<const uchar*>(data)[i]) * CV_BIG_UINT(0x100000001b3);
    }
    uint64 value() const { return state; }

private:
    uint64 state;
};

//! The eight letters, the newest version that can be read, and the name of such a file in errors.
struct FileKind
{
    const char* letters;
    unsigned version;
    const char* name;
};

class CV_EXPORTS CheckedWriter
{
public:
    CheckedWriter(const String& filename, const FileKind& kind);
    void bytes(const void* data, size_t size);
    void number(uint64 value, int size);
    void real(float value);
    //! Writes the number of values, then the values, `size` bytes each.
    template <typename T> void list(const std::vector<T>& values, int size)
    {
        number(values.size(), size);
        for (T value : values)
            number((uint64)value, size);
    }
    //! Writes the hash so far, and returns it.
    uint64 seal();
    //! Writes bytes that the hash does not cover, after seal().
    void unchecked(const void* data, size_t size);
    //! Bytes so far.
    uint64 size() const { return written; }
    void finish() { file->finish(); }
    void commit() { file->commit(); }

private:
    Ptr<WholeFile> file;
    Fnv1a hash;
    uint64 written;
};

class CV_EXPORTS CheckedReader
{
public:
    CheckedReader(const String& filename, const FileKind& kind);
    void bytes(void* data, size_t size);
    uint64 number(int size);
    unsigned word() { return (unsigned)number(4); }
    float real();
    template <typename T> std::vector<T> list(int size)
    {
        const uint64 count = number(size);
        expect(count, size);
        std::vector<T> values;
        for (uint64 i = 0; i < count; i++)
            values.push_back((T)number(size));
        return values;
    }
    //! Reads the hash of everything before it, and returns it; throws if it is wrong.
    uint64 seal();
    //! The file's version, from 1 to the newest that can be read.
    unsigned version() const { return format; }
    //! Bytes read so far.
    uint64 position() const { return whole - rest; }
    //! Throws if there is more to read.
    void expectEnd() const;
    //! Throws if fewer than count * size bytes are left: a damaged file must not make the reader allocate more.
    void expect(uint64 count, uint64 size) const;
    //! @throws cv::Exception that names the file, its expected kind, and the reason.
    void fail(const String& why) const;

private:
    String name;
    const char* kindName;
    std::ifstream stream;
    Fnv1a hash;
    uint64 whole, rest;
    unsigned format;
};

//! @endcond

}}  // namespace cv::iib

#endif
