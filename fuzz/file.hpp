// SPDX-License-Identifier: Apache-2.0
#pragma once

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
