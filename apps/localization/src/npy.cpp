// SPDX-License-Identifier: Apache-2.0

#include "npy.hpp"

#include <cstdint>
#include <cstdio>
#include <fstream>

namespace iib_localization {
namespace {

const std::string MAGIC("\x93NUMPY\x01\0", 8);

//! What stands after a key of the header, which is written as a Python dictionary, blanks left out.
std::string valueOf(const std::string& header, const std::string& key)
{
    const size_t at = header.find("'" + key + "':");
    return at == std::string::npos ? std::string() : header.substr(at + key.size() + 3);
}

}  // namespace

cv::Mat readNpy(const std::string& file)
{
    std::ifstream in(file, std::ios::binary);
    std::string magic(MAGIC.size(), ' '), header, packed;
    unsigned char size[2] = {};
    in.read(&magic[0], std::streamsize(magic.size()));
    in.read(reinterpret_cast<char*>(size), sizeof(size));
    header.resize(size[0] | size_t(size[1]) << 8);
    if (!in.read(&header[0], std::streamsize(header.size())) || magic != MAGIC)
        CV_Error(cv::Error::StsParseError, file + ": not a readable .npy file");
    for (char c : header)
        if (c != ' ')
            packed += c;
    int rows = 0, columns = 0;
    char closing = 0;
    const bool flat =
            std::sscanf(valueOf(packed, "shape").c_str(), "(%d,%d%c", &rows, &columns, &closing) == 3;
    if (valueOf(packed, "descr").find("'|u1'") != 0 || valueOf(packed, "fortran_order").find("False") != 0 ||
            !flat || closing != ')' || rows < 0 || columns < 1)
        CV_Error(cv::Error::StsUnsupportedFormat, file + ": not a two-dimensional array of uint8 in C order");
    const std::streampos start = in.tellg();
    in.seekg(0, std::ios::end);
    if (!in || uint64_t(in.tellg() - start) != uint64_t(rows) * uint64_t(columns))
        CV_Error(cv::Error::StsParseError, file + ": not as many bytes as its header says");
    in.seekg(start);
    cv::Mat array(rows, columns, CV_8U);
    if (!in.read(array.ptr<char>(), std::streamsize(array.total())))
        CV_Error(cv::Error::StsParseError, file + ": cannot be read to its end");
    return array;
}

}  // namespace iib_localization
