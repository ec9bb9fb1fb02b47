// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#ifndef OPENCV_IIB_FUZZ_FILE_HPP
#define OPENCV_IIB_FUZZ_FILE_HPP

#include "opencv2/core/utility.hpp"
#include "opencv2/core/utils/filesystem.hpp"

#include <cstdio>
#include <fstream>
#include <string>

inline void writeFile(const cv::String& name, const std::string& bytes)
{
    std::ofstream(name.c_str(), std::ios::binary).write(bytes.data(), (std::streamsize)bytes.size());
}

//! A file for readers that want one; goes with the object.
struct ScratchFile
{
    const cv::String name;

    explicit ScratchFile(const char* suffix = ".iib") : name(cv::tempfile(suffix)) {}
    ~ScratchFile() { std::remove(name.c_str()); }
    void write(const std::string& bytes) const { writeFile(name, bytes); }
};

//! A folder that goes with the object.
struct ScratchFolder
{
    const cv::String name;

    ScratchFolder() : name(cv::tempfile(".folder")) { cv::utils::fs::createDirectory(name); }
    ~ScratchFolder() { cv::utils::fs::remove_all(name); }
};

#endif
