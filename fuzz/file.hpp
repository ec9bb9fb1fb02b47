// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#ifndef OPENCV_IIB_FUZZ_FILE_HPP
#define OPENCV_IIB_FUZZ_FILE_HPP

#include "opencv2/core/utility.hpp"

#include <cstdio>
#include <fstream>
#include <string>

//! A file for readers that want one; goes with the object.
struct ScratchFile
{
    const cv::String name;

    explicit ScratchFile(const char* suffix = ".iib") : name(cv::tempfile(suffix)) {}
    ~ScratchFile() { std::remove(name.c_str()); }
    void write(const std::string& bytes) const
    {
        std::ofstream(name.c_str(), std::ios::binary).write(bytes.data(), (std::streamsize)bytes.size());
    }
};

#endif
