// SPDX-License-Identifier: Apache-2.0
#include "precomp.hpp"
#include "index_folder.hpp"
#include "opencv2/iib/detail/files.hpp"

#ifdef _WIN32
#define NOMINMAX 1  // the value of libstdc++
#include <windows.h>
#else
#include "opencv2/core/utils/filesystem.hpp"
#endif

#include <cstdio>

namespace cv { namespace iib {

static const char *const MANIFEST = "manifest.iib", *const SEGMENT = "segment-%06llu.iib",
                         *const LOCK = "lock";

String manifestOf(const String& folder) { return folder + "/" + MANIFEST; }

String segmentOf(const String& folder, uint64 number)
{
    return folder + "/" + format(SEGMENT, (unsigned long long)number);
}

String lockOf(const String& folder) { return folder + "/" + LOCK; }

static bool isUnfinished(const String& name)
{
    unsigned long long segment = 0;
    std::sscanf(name.c_str(), "segment-%llu.iib", &segment);
    return isPartOf(MANIFEST, name) || isPartOf(format(SEGMENT, segment), name);
}

#ifdef _WIN32  // OpenCV's functions accept only names in the code page
static void makeDirectory(const String& name) { CreateDirectoryW(systemName(name).c_str(), 0); }
static bool isDirectory(const String& name)
{
    const DWORD attributes = GetFileAttributesW(systemName(name).c_str());
    return attributes != INVALID_FILE_ATTRIBUTES && (attributes & FILE_ATTRIBUTE_DIRECTORY) != 0;
}
static void removeFile(const String& name) { DeleteFileW(systemName(name).c_str()); }
static std::vector<String> namesIn(const String& folder)
{
    std::vector<String> names;
    WIN32_FIND_DATAW found;
    const HANDLE search = FindFirstFileW(systemName(folder + "/*").c_str(), &found);
    for (bool more = search != INVALID_HANDLE_VALUE; more; more = FindNextFileW(search, &found) != 0)
    {
        char name[3 * MAX_PATH + 1];
        WideCharToMultiByte(CP_UTF8, 0, found.cFileName, -1, name, sizeof(name), 0, 0);
        if (name != String(".") && name != String(".."))
            names.push_back(name);
    }
    FindClose(search);
    return names;
}
#else
static void makeDirectory(const String& name) { utils::fs::createDirectory(name); }
static bool isDirectory(const String& name) { return utils::fs::isDirectory(name); }
static void removeFile(const String& name) { std::remove(name.c_str()); }
static std::vector<String> namesIn(const String& folder)
{
    std::vector<String> names;
    utils::fs::glob_relative(folder, String(), names, false, true);
    return names;
}
#endif

void makeFolder(const String& folder)
{
    if (!isDirectory(folder))
        makeDirectory(folder);
    if (!isDirectory(folder))
        CV_Error(Error::StsError, "Cannot make the folder " + folder + ": check its parent and the rights");
}

void checkEmpty(const String& folder)
{
    for (const String& name : namesIn(folder))
    {
        if (name == MANIFEST)
            CV_Error(Error::StsBadArg, folder + " already holds an index: open it, or choose another folder");
        if (name != LOCK && !isUnfinished(name))
            CV_Error(Error::StsBadArg, folder + " holds " + name + ": choose an empty folder");
    }
}

void removeUnfinished(const String& folder)
{
    for (const String& name : namesIn(folder))
        if (isUnfinished(name))
            removeFile(folder + "/" + name);
}

static const FileKind KIND = {"IIBSHARD", 1, "the manifest of a MappedIndex"};

CheckedWriter writeManifest(const String& filename, Manifest& manifest)
{
    CheckedWriter file(filename, KIND);
    file.list(manifest.levelSizes, 4);
    file.number(manifest.segments.size(), 8);
    for (const SegmentEntry& segment : manifest.segments)
        for (uint64 value : {segment.number, segment.rows, segment.images, segment.checksum})
            file.number(value, 8);
    file.list(manifest.removed, 8);
    manifest.checksum = file.seal();
    return file;
}

// Checks the invariants of a commit; sums of its numbers cannot overflow then.
static bool isConsistent(const Manifest& manifest)
{
    const uint64 limit = (uint64)1 << INDEX_BITS;
    uint64 rows = 0, images = 0, last = 0;
    for (const SegmentEntry& segment : manifest.segments)
    {
        if (segment.number <= last || segment.rows >= limit - rows || segment.images >= limit - images)
            return false;
        last = segment.number;
        rows += segment.rows;
        images += segment.images;
    }
    for (size_t i = 0; i < manifest.removed.size(); i++)
        if (manifest.removed[i] >= images || (i > 0 && manifest.removed[i] <= manifest.removed[i - 1]))
            return false;
    return true;
}

Manifest readManifest(const String& filename)
{
    CheckedReader file(filename, KIND);
    Manifest manifest;
    manifest.levelSizes = file.list<int>(4);
    const uint64 segments = file.number(8);
    file.expect(segments, 4 * 8);
    for (uint64 i = 0; i < segments; i++)
    {
        SegmentEntry segment;
        for (uint64* value : {&segment.number, &segment.rows, &segment.images, &segment.checksum})
            *value = file.number(8);
        manifest.segments.push_back(segment);
    }
    manifest.removed = file.list<uint64>(8);
    manifest.checksum = file.seal();
    file.expectEnd();
    if (!isConsistent(manifest))
        file.fail("the numbers of its segments and images are inconsistent");
    return manifest;
}

}}  // namespace cv::iib
