// SPDX-License-Identifier: Apache-2.0

#include "precomp.hpp"
#include "code_segment.hpp"
#include "opencv2/iib/detail/files.hpp"

#ifdef _WIN32
#define NOMINMAX 1  // the value of libstdc++
#include <windows.h>
#else
#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>
#endif

namespace cv { namespace iib {

#ifdef _WIN32

MappedFile::MappedFile(const String& filename) : bytes(0), length(0)
{
    const HANDLE file = CreateFileW(systemName(filename).c_str(), GENERIC_READ,
            FILE_SHARE_READ | FILE_SHARE_DELETE, 0, OPEN_EXISTING, FILE_ATTRIBUTE_NORMAL, 0);
    LARGE_INTEGER size;
    const bool opened = file != INVALID_HANDLE_VALUE && GetFileSizeEx(file, &size);
    if (opened && size.QuadPart > 0)
        if (const HANDLE mapping = CreateFileMappingW(file, 0, PAGE_READONLY, 0, 0, 0))
        {
            bytes = (const uchar*)MapViewOfFile(mapping, FILE_MAP_READ, 0, 0, 0);
            CloseHandle(mapping);
        }
    if (file != INVALID_HANDLE_VALUE)
        CloseHandle(file);
    if (!bytes)
        CV_Error(Error::StsError, "Cannot read " + filename);
    length = (size_t)size.QuadPart;
}

MappedFile::~MappedFile() { UnmapViewOfFile(bytes); }

#else

MappedFile::MappedFile(const String& filename) : bytes(0), length(0)
{
    const int file = open(filename.c_str(), O_RDONLY | O_CLOEXEC);
    struct stat status;
    void* mapped = MAP_FAILED;
    if (file >= 0 && fstat(file, &status) == 0 && status.st_size > 0)
        mapped = mmap(0, (size_t)status.st_size, PROT_READ, MAP_SHARED, file, 0);
    if (file >= 0)
        close(file);
    if (mapped == MAP_FAILED)
        CV_Error(Error::StsError, "Cannot read " + filename);
    bytes = (const uchar*)mapped;
    length = (size_t)status.st_size;
}

MappedFile::~MappedFile() { munmap((void*)bytes, length); }

#endif

}}  // namespace cv::iib
