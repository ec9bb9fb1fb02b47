// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#ifndef OPENCV_IIB_TEST_SUPPORT_TEMPORARY_FILE_HPP
#define OPENCV_IIB_TEST_SUPPORT_TEMPORARY_FILE_HPP

#include "../test_precomp.hpp"

#include <fstream>

namespace opencv_test {

//! A name for a file that goes with the object.
struct TemporaryFile
{
    String name;
    explicit TemporaryFile(const char* extension = ".iib") : name(cv::tempfile(extension)) {}
    ~TemporaryFile() { std::remove(name.c_str()); }
    void write(const std::string& bytes) const
    {
        std::ofstream(name.c_str(), std::ios::binary).write(bytes.data(), bytes.size());
    }
    std::string read() const
    {
        std::ifstream in(name.c_str(), std::ios::binary);
        return std::string(std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>());
    }
};

}  // namespace opencv_test

#endif
