// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#include "../precomp.hpp"
#include "index_file.hpp"

#include <cstring>

namespace cv {
namespace iib {

static const char MAGIC[] = "IIBINDEX";
static const size_t MAGIC_SIZE = sizeof(MAGIC) - 1;
static const unsigned VERSION = 1;

IndexWriter::IndexWriter(const String& filename, const IndexHeader& header) : file(filename)
{
    const MatcherParameters& p = header.parameters;
    bytes(MAGIC, MAGIC_SIZE);
    number(VERSION, 4);
    number(p.levelSizes.size(), 4);
    for (size_t i = 0; i < p.levelSizes.size(); i++)
        number(p.levelSizes[i], 4);
    number(p.mode, 4);
    number(p.crossCheck, 4);
    real(p.maxRatio);
    for (size_t i = 0; i < p.thresholds.size(); i++)
        real(p.thresholds[i]);
    number(header.rows.size(), 8);
    for (size_t i = 0; i < header.rows.size(); i++)
        number(header.rows[i], 8);
}

void IndexWriter::finish()
{
    number(hash.value(), 8);
    file.commit();
}

void IndexWriter::bytes(const void* data, size_t size)
{
    hash.add(data, size);
    file.write(data, size);
}

void IndexWriter::number(uint64 value, int size)
{
    uchar data[8];
    for (int i = 0; i < size; i++)
        data[i] = (uchar)(value >> 8 * i);
    bytes(data, size);
}

void IndexWriter::real(float value)
{
    unsigned word;
    std::memcpy(&word, &value, sizeof(word));
    number(word, 4);
}

IndexReader::IndexReader(const String& filename)
    : name(filename), stream(filename.c_str(), std::ios::binary), left(0)
{
    stream.seekg(0, std::ios::end);
    const std::streamoff size = stream.tellg();
    stream.seekg(0);
    if (!stream || size < 0)
        CV_Error(Error::StsError, "Cannot read " + name);
    left = (uint64)size;
    readHeader();
}

void IndexReader::readHeader()
{
    char magic[MAGIC_SIZE];
    bytes(magic, sizeof(magic));
    if (std::memcmp(magic, MAGIC, sizeof(magic)) != 0)
        fail("it is a file of another kind");
    const unsigned version = word();
    if (version == 0)
        fail("its format 0 does not exist: it is altered");
    if (version > VERSION)
        fail(format("its format %u is newer than this library's, %u", version, VERSION));

    MatcherParameters& p = head.parameters;
    const unsigned levels = word();
    expect(levels, 4);
    uint64 width = 0;
    for (unsigned i = 0; i < levels; i++)
    {
        p.levelSizes.push_back((int)word());
        width += (unsigned)p.levelSizes.back();
    }
    p.mode = (int)word();
    p.crossCheck = word() != 0;
    p.maxRatio = real();
    for (unsigned i = 1; i < levels; i++)
        p.thresholds.push_back(real());

    const uint64 images = number(8);
    expect(images, 8);
    head.rows.resize((size_t)images);
    uint64 total = 0;
    for (size_t i = 0; i < head.rows.size(); i++)
    {
        total += head.rows[i] = number(8);
        if (head.rows[i] > INT_MAX || width > INT_MAX || (width == 0 && head.rows[i] > 0))
            fail("its numbers do not make sense");
        expect(total, width);
    }
}

void IndexReader::finish()
{
    const uint64 expected = hash.value();
    if (number(8) != expected || left != 0)
        fail("it is altered: its checksum does not fit");
}

void IndexReader::expect(uint64 count, uint64 size) const
{
    if (size != 0 && count > left / size)
        fail("it is truncated or altered");
}

void IndexReader::bytes(void* data, size_t size)
{
    expect(size, 1);
    stream.read((char*)data, size);
    if (!stream)
        fail("it is truncated");
    hash.add(data, size);
    left -= size;
}

uint64 IndexReader::number(int size)
{
    uchar data[8];
    bytes(data, size);
    uint64 value = 0;
    for (int i = 0; i < size; i++)
        value |= (uint64)data[i] << 8 * i;
    return value;
}

float IndexReader::real()
{
    const unsigned bits = word();
    float value;
    std::memcpy(&value, &bits, sizeof(value));
    return value;
}

void IndexReader::fail(const String& why) const
{
    CV_Error(Error::StsParseError, name + " cannot be read as an index of HierarchicalMatcher: " + why);
}

}  // namespace iib
}  // namespace cv
