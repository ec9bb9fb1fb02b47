// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#include "../precomp.hpp"
#include "index_file.hpp"

#include <cstring>
#include <fstream>

namespace cv {
namespace iib {

namespace {

const char MAGIC[] = "IIBINDEX";
const unsigned VERSION = 1;

class Fnv1a
{
public:
    Fnv1a() : state(0xcbf29ce484222325ull) {}
    void add(const char* data, size_t size)
    {
        for (size_t i = 0; i < size; i++)
            state = (state ^ (uchar)data[i]) * 0x100000001b3ull;
    }
    uint64 value() const { return state; }

private:
    uint64 state;
};

class Writer
{
public:
    explicit Writer(const String& filename) : name(filename), stream(filename.c_str(), std::ios::binary) {}
    void bytes(const void* data, size_t size)
    {
        hash.add((const char*)data, size);
        stream.write((const char*)data, size);
    }
    void number(uint64 value, int size)
    {
        char data[8];
        for (int i = 0; i < size; i++)
            data[i] = (char)(value >> 8 * i);
        bytes(data, size);
    }
    void real(float value)
    {
        unsigned word;
        std::memcpy(&word, &value, sizeof(word));
        number(word, 4);
    }
    void finish()
    {
        number(hash.value(), 8);
        stream.close();
        if (!stream)
            CV_Error(Error::StsError,
                    "Cannot write " + name + ": check the folder, its rights and the free space");
    }

private:
    String name;
    std::ofstream stream;
    Fnv1a hash;
};

class Reader
{
public:
    explicit Reader(const String& filename)
        : name(filename), stream(filename.c_str(), std::ios::binary), left(0)
    {
        stream.seekg(0, std::ios::end);
        const std::streamoff size = stream.tellg();
        stream.seekg(0);
        if (!stream || size < 0)
            CV_Error(Error::StsError, "Cannot read " + name);
        left = (uint64)size;
    }
    // Whatever the file claims, no more memory is asked for than it has bytes.
    void expect(uint64 count, uint64 size)
    {
        if (size != 0 && count > left / size)
            fail("it is truncated or altered");
    }
    void bytes(void* data, size_t size)
    {
        expect(size, 1);
        stream.read((char*)data, size);
        if (!stream)
            fail("it is truncated");
        hash.add((const char*)data, size);
        left -= size;
    }
    uint64 number(int size)
    {
        uchar data[8];
        bytes(data, size);
        uint64 value = 0;
        for (int i = 0; i < size; i++)
            value |= (uint64)data[i] << 8 * i;
        return value;
    }
    unsigned word() { return (unsigned)number(4); }
    float real()
    {
        const unsigned bits = word();
        float value;
        std::memcpy(&value, &bits, sizeof(value));
        return value;
    }
    void finish()
    {
        const uint64 expected = hash.value();
        if (number(8) != expected || left != 0)
            fail("it is altered: its checksum does not fit");
    }
    void fail(const String& why) const
    {
        CV_Error(Error::StsParseError, name + " cannot be read as an index of HierarchicalMatcher: " + why);
    }

private:
    String name;
    std::ifstream stream;
    uint64 left;
    Fnv1a hash;
};

}  // namespace

void writeIndexFile(const String& filename, const IndexFile& file)
{
    Writer out(filename);
    out.bytes(MAGIC, sizeof(MAGIC) - 1);
    out.number(VERSION, 4);
    out.number(file.levelSizes.size(), 4);
    for (size_t i = 0; i < file.levelSizes.size(); i++)
        out.number(file.levelSizes[i], 4);
    out.number(file.mode, 4);
    out.number(file.crossCheck, 4);
    out.real(file.maxRatio);
    for (size_t i = 0; i < file.thresholds.size(); i++)
        out.real(file.thresholds[i]);
    out.number(file.images.size(), 8);
    for (size_t i = 0; i < file.images.size(); i++)
        out.number(file.images[i].rows, 8);
    for (size_t i = 0; i < file.images.size(); i++)
        out.bytes(file.images[i].data, file.images[i].total());
    out.finish();
}

IndexFile readIndexFile(const String& filename)
{
    Reader in(filename);
    char magic[sizeof(MAGIC) - 1];
    in.bytes(magic, sizeof(magic));
    if (std::memcmp(magic, MAGIC, sizeof(magic)) != 0)
        in.fail("it is a file of another kind");
    const unsigned version = in.word();
    if (version == 0 || version > VERSION)
        in.fail(format("its format %u is newer than this library's, %u", version, VERSION));

    IndexFile file;
    const unsigned levels = in.word();
    in.expect(levels, 4);
    uint64 width = 0;
    for (unsigned i = 0; i < levels; i++)
    {
        file.levelSizes.push_back((int)in.word());
        width += (unsigned)file.levelSizes.back();
    }
    file.mode = (int)in.word();
    file.crossCheck = in.word() != 0;
    file.maxRatio = in.real();
    for (unsigned i = 1; i < levels; i++)
        file.thresholds.push_back(in.real());
    const uint64 images = in.number(8);
    in.expect(images, 8);
    std::vector<uint64> rows((size_t)images);
    for (size_t i = 0; i < rows.size(); i++)
        rows[i] = in.number(8);
    for (size_t i = 0; i < rows.size(); i++)
    {
        in.expect(rows[i], width);
        if (rows[i] > INT_MAX || width > INT_MAX || (width == 0 && rows[i] > 0))
            in.fail("its numbers do not make sense");
        file.images.push_back(Mat((int)rows[i], (int)width, CV_8U));
        in.bytes(file.images.back().data, file.images.back().total());
    }
    in.finish();
    return file;
}

}  // namespace iib
}  // namespace cv
