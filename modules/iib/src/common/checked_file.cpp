// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#include "../precomp.hpp"
#include "opencv2/iib/detail/checked_file.hpp"

#include <cstring>

namespace cv { namespace iib {

static const size_t LETTERS = 8;

CheckedWriter::CheckedWriter(const String& filename, const FileKind& kind)
    : file(makePtr<WholeFile>(filename)), written(0)
{
    bytes(kind.letters, LETTERS);
    number(kind.version, 4);
}

void CheckedWriter::bytes(const void* data, size_t size)
{
    hash.add(data, size);
    unchecked(data, size);
}

void CheckedWriter::unchecked(const void* data, size_t size)
{
    file->write(data, size);
    written += size;
}

// Files are little-endian, as all supported machines are.
void CheckedWriter::number(uint64 value, int size) { bytes(&value, size); }

void CheckedWriter::real(float value) { bytes(&value, sizeof(value)); }

uint64 CheckedWriter::seal()
{
    const uint64 value = hash.value();
    number(value, 8);
    return value;
}

CheckedReader::CheckedReader(const String& filename, const FileKind& kind)
    : name(checkedName(filename)), kindName(kind.name), whole(0), rest(0), format(0)
{
    openToRead(*stream.rdbuf(), name);
    stream.seekg(0, std::ios::end);
    const std::streamoff end = stream.tellg();
    stream.seekg(0);
    if (!stream || end < 0)
        CV_Error(Error::StsError, "Cannot read " + name);
    whole = rest = (uint64)end;
    char letters[LETTERS];
    bytes(letters, sizeof(letters));
    if (std::memcmp(letters, kind.letters, sizeof(letters)) != 0)
        fail("it is a file of another kind");
    format = word();
    if (format == 0)
        fail("its format 0 does not exist: it is altered");
    if (format > kind.version)
        fail(cv::format("its format %u is newer than this library's, %u", format, kind.version));
}

uint64 CheckedReader::seal()
{
    const uint64 expected = hash.value();
    if (number(8) != expected)
        fail("it is altered: its checksum is wrong");
    return expected;
}

void CheckedReader::expect(uint64 count, uint64 size) const
{
    if (size != 0 && count > rest / size)
        fail("it is truncated or altered");
}

void CheckedReader::expectEnd() const
{
    if (rest != 0)
        fail("it is altered: there is data beyond its end");
}

void CheckedReader::bytes(void* data, size_t size)
{
    expect(size, 1);
    stream.read((char*)data, size);
    if (!stream)
        fail("it is truncated");
    hash.add(data, size);
    rest -= size;
}

uint64 CheckedReader::number(int size)
{
    uint64 value = 0;
    bytes(&value, size);
    return value;
}

float CheckedReader::real()
{
    float value = 0;
    bytes(&value, sizeof(value));
    return value;
}

void CheckedReader::fail(const String& why) const
{
    CV_Error(Error::StsParseError, name + " cannot be read as " + kindName + ": " + why);
}

}}  // namespace cv::iib
