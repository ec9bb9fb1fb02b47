// SPDX-License-Identifier: Apache-2.0

#include "npy.hpp"

#include <zlib.h>

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
    uLong sum = ::crc32_z(0, reinterpret_cast<const uchar*>(head.data()), head.size());
    sum = ::crc32_z(sum, array.ptr(), bytes);
    if (cv::format("%08lx", sum) != checksum)
        CV_Error(cv::Error::StsParseError, file + " is damaged");
    return array;
}

}  // namespace iib_localization
