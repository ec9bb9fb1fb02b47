// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#pragma once

#include "test_precomp.hpp"

#include "opencv2/core/utils/filesystem.hpp"

#include <fstream>

#ifdef __linux__
#include <csignal>
#include <sys/resource.h>
#endif

namespace opencv_test {

inline void writeFile(const String& name, const std::string& bytes)
{
    std::ofstream(name.c_str(), std::ios::binary).write(bytes.data(), bytes.size());
}

inline std::string readFile(const String& name)
{
    std::ifstream in(name.c_str(), std::ios::binary);
    return std::string(std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>());
}

//! A file name; the destructor removes the file.
struct TemporaryFile
{
    String name;
    explicit TemporaryFile(const char* extension = ".iib") : name(cv::tempfile(extension)) {}
    ~TemporaryFile() { std::remove(name.c_str()); }
    void write(const std::string& bytes) const { writeFile(name, bytes); }
    std::string read() const { return readFile(name); }
};

//! A folder; the destructor removes it with its content.
struct TemporaryFolder
{
    String name;
    TemporaryFolder() : name(cv::tempfile(".folder")) { utils::fs::createDirectory(name); }
    ~TemporaryFolder() { utils::fs::remove_all(name); }
};

//! Calls check(name) for files of every format, of save() and of write().
template <typename Class, typename Check> void forEachFileOf(const Class& object, const Check& check)
{
    for (const char* extension : {".yml", ".xml", ".json"})
        for (bool save : {false, true})
        {
            SCOPED_TRACE(format("%s, save %d", extension, save));
            const TemporaryFile file(extension);
            save ? object.save(file.name) : object.write(file.name);
            check(file.name);
        }
}

//! A file; the destructor restores its content.
struct RestoredFile
{
    const String name;
    const std::string bytes;
    explicit RestoredFile(const String& name_) : name(name_), bytes(readFile(name_)) {}
    ~RestoredFile() { write(bytes); }
    void write(const std::string& altered) const { writeFile(name, altered); }
};

#ifdef __linux__
//! No file grows beyond this size, as on a full disk.
struct FullDisk
{
    rlimit before;
    explicit FullDisk(rlim_t bytes)
    {
        getrlimit(RLIMIT_FSIZE, &before);
        rlimit limit = before;
        limit.rlim_cur = bytes;
        signal(SIGXFSZ, SIG_IGN);
        setrlimit(RLIMIT_FSIZE, &limit);
    }
    ~FullDisk() { setrlimit(RLIMIT_FSIZE, &before); }
};
#endif

}  // namespace opencv_test
