// SPDX-License-Identifier: Apache-2.0

#include "npy.hpp"

#include <array>
#include <cstdio>
#include <filesystem>
#include <fstream>

namespace iib_localization {
namespace {

const std::string MAGIC("\x93NUMPY\x01\0", 8);
constexpr size_t FRONT = 10;  // magic and length of the header

//! An array of so many bytes to read into, empty for another header than that of the type.
cv::Mat arrayOf(const std::string& header, int type, uint64_t bytes)
{
    const std::string name = type == CV_8U ? "|u1" : type == CV_32S ? "<i4" : "<f8";
    const std::string shape = "{'descr': '" + name + "', 'fortran_order': False, 'shape': (%d,%d";
    int rows = 0, columns = 1;
    const bool valid = std::sscanf(header.c_str(), shape.c_str(), &rows, &columns) >= 1;
    const uint64_t column = uint64_t(std::max(rows, 1)) * uint64_t(CV_ELEM_SIZE(type));  // bytes
    const bool fits =
            valid && rows > 0 && columns > 0 && bytes % column == 0 && bytes / column == uint64_t(columns);
    return fits ? cv::Mat(rows, columns, type) : cv::Mat();
}

}  // namespace

uint32_t crc32(const void* data, size_t size, uint32_t sum)
{
    static const std::array<uint32_t, 256> table = [] {
        std::array<uint32_t, 256> made{};
        for (uint32_t i = 0; i < made.size(); i++)
        {
            made[i] = i;
            for (int bit = 0; bit < 8; bit++)
                made[i] = made[i] >> 1 ^ (made[i] & 1 ? 0xedb88320u : 0);
        }
        return made;
    }();
    sum = ~sum;
    for (const uchar *at = static_cast<const uchar*>(data), *end = at + size; at < end; at++)
        sum = sum >> 8 ^ table[(sum ^ *at) & 255];
    return ~sum;
}

cv::Mat readNpy(const std::string& file, int type, const std::string& checksum)
{
    std::ifstream in(file, std::ios::binary);
    std::string head(FRONT, ' ');
    std::error_code error;
    const uint64_t size = std::filesystem::file_size(file, error);
    cv::Mat array;
    if (!error && in.read(&head[0], FRONT) && head.compare(0, MAGIC.size(), MAGIC) == 0)
    {
        head.resize(FRONT + (uchar(head[8]) | size_t(uchar(head[9])) << 8));
        in.read(&head[FRONT], std::streamsize(head.size() - FRONT));
        array = arrayOf(head.substr(FRONT), type, size - std::min(uint64_t(head.size()), size));
    }
    const size_t bytes = array.total() * array.elemSize();
    if (array.empty() || !in.read(array.ptr<char>(), std::streamsize(bytes)))
        CV_Error(cv::Error::StsParseError, file + " is missing or damaged");
    if (cv::format("%08x", crc32(array.ptr(), bytes, crc32(head.data(), head.size()))) != checksum)
        CV_Error(cv::Error::StsParseError, file + " is damaged");
    return array;
}

}  // namespace iib_localization
