// SPDX-License-Identifier: Apache-2.0

#include "npy.hpp"

#include <cstdio>
#include <fstream>

namespace iib_tools {
namespace {

const char MAGIC[] = "\x93NUMPY";
const size_t MAGIC_SIZE = sizeof(MAGIC) - 1;
const size_t LARGEST_HEADER = 65536;
const int LARGEST_SIDE = 1 << 24;

//! What stands after a key of the header, which is written as a Python dictionary, blanks left out.
std::string valueOf(const std::string& header, const std::string& key)
{
    const size_t at = header.find("'" + key + "':");
    return at == std::string::npos ? std::string() : header.substr(at + key.size() + 3);
}

bool beginsWith(const std::string& text, const std::string& start)
{
    return text.compare(0, start.size(), start) == 0;
}

}  // namespace

cv::Mat readNpy(const std::string& file)
{
    std::ifstream in(file, std::ios::binary);
    char magic[MAGIC_SIZE + 2] = {};
    in.read(magic, sizeof(magic));
    if (!in || std::string(magic, MAGIC_SIZE) != MAGIC)
        CV_Error(cv::Error::StsParseError, file + ": not a readable .npy file");
    unsigned char bytes[4] = {};
    in.read(reinterpret_cast<char*>(bytes), magic[MAGIC_SIZE] == 1 ? 2 : 4);
    const size_t size = bytes[0] | size_t(bytes[1]) << 8 | size_t(bytes[2]) << 16 | size_t(bytes[3]) << 24;
    if (!in || size > LARGEST_HEADER)
        CV_Error(cv::Error::StsParseError, file + ": a .npy file with a broken header");
    std::string header(size, ' '), packed;
    in.read(&header[0], std::streamsize(size));
    for (char c : header)
        if (c != ' ')
            packed += c;

    const std::string type = valueOf(packed, "descr");
    const bool floats = beginsWith(type, "'<f4'");
    int rows = 0, columns = 0;
    char closing = 0;
    const bool flat =
            std::sscanf(valueOf(packed, "shape").c_str(), "(%d,%d%c", &rows, &columns, &closing) == 3;
    if (!(floats || beginsWith(type, "'|u1'")) || !beginsWith(valueOf(packed, "fortran_order"), "False") ||
            !flat || closing != ')' || rows < 0 || columns < 1 || rows > LARGEST_SIDE ||
            columns > LARGEST_SIDE)
        CV_Error(cv::Error::StsUnsupportedFormat,
                file + ": not a two-dimensional array of float32 or uint8 in C order");
    const size_t total = size_t(rows) * size_t(columns) * (floats ? 4 : 1);
    const std::streampos start = in.tellg();
    in.seekg(0, std::ios::end);
    if (!in || size_t(in.tellg() - start) != total)
        CV_Error(cv::Error::StsParseError, file + ": not as many bytes as its header says");
    in.seekg(start);
    cv::Mat array(rows, columns, floats ? CV_32F : CV_8U);
    in.read(array.ptr<char>(), std::streamsize(total));
    if (!in)
        CV_Error(cv::Error::StsParseError, file + ": cannot be read to its end");
    return array;
}

}  // namespace iib_tools
