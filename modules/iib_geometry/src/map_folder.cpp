// SPDX-License-Identifier: Apache-2.0

#include "map_folder.hpp"

#include <algorithm>
#include <filesystem>

#include <fcntl.h>
#ifdef _WIN32
#include <io.h>
#include <share.h>
#include <sys/stat.h>
#else
#include <sys/file.h>
#include <unistd.h>
#endif

#include "../../iib/src/common/checked_file.hpp"

namespace cv::iib {
namespace {

namespace fs = std::filesystem;

//! What a folder of a map holds, and one of an earlier version; the first names tell that it is one.
const std::vector<std::string> OWN = {"map.iib", "cameras.bin", "images.bin", "points3D.bin"};
const std::vector<std::string> EARLIER = {"map.json", "codes.npy", "misses.npy", "points.npy", "sees.npy",
        "views.npy", "rigs.bin", "frames.bin"};

//! Whether a file has one of these names, or that of one which a killed process has not finished.
bool isOf(const std::vector<std::string>& names, const std::string& name)
{
    const bool unfinished = fs::path(name).extension() == ".tmp";
    return std::any_of(names.begin(), names.end(), [&](const std::string& own) {
        return name == own || (unfinished && name.compare(0, own.size() + 1, own + ".") == 0);
    });
}

//! A descriptor that keeps other processes from locking the folder until it is closed; below 0 if one has locked it.
int lockFolder(const fs::path& folder)
{
#ifdef _WIN32  // where no folder is locked: a file beside it, which goes when it is closed
    return ::_wsopen((folder.wstring() + L".lock").c_str(), _O_CREAT | _O_RDWR | _O_TEMPORARY | _O_NOINHERIT,
            _SH_DENYRW, _S_IREAD | _S_IWRITE);
#else
    const int lock = ::open(folder.c_str(), O_RDONLY | O_CLOEXEC);
    if (lock >= 0 && ::flock(lock, LOCK_EX | LOCK_NB) == 0)
        return lock;
    if (lock >= 0)
        ::close(lock);
    return -1;
#endif
}

}  // namespace

MapFolder::MapFolder(const std::string& folder) : folder_(folder)
{
    std::error_code error;
    const fs::path path = systemName(folder);
    fs::create_directories(path, error);
    bool known = false, any = false;
    for (fs::directory_iterator entry(path, error), end; !error && entry != end; entry.increment(error))
    {
        const std::string name = entry->path().filename().u8string();
        any = true;
        known = known || isOf({OWN[0], EARLIER[0]}, name);
        if (!isOf(OWN, name) && !isOf(EARLIER, name))
            CV_Error(Error::StsError, folder + " holds " + name + " and is no map: choose another folder");
    }
    if (error)
        CV_Error(Error::StsError, folder + " cannot be written: " + error.message());
    if (any && !known)
        CV_Error(Error::StsError, folder + " holds a COLMAP model and is no map: choose another folder");
    lock_ = lockFolder(path);
    if (lock_ < 0)
        CV_Error(Error::StsError, folder + " is being written by another process: wait until it has ended");
}

MapFolder::~MapFolder() { ::close(lock_); }

void MapFolder::write(const Map& map) const
{
    writeMap(folder_, map, [&] { writeModel(folder_, {map.images.begin(), map.images.end()}, map.points); });
    std::error_code error;
    for (fs::directory_iterator entry(systemName(folder_), error), end; !error && entry != end;
            entry.increment(error))
        if (std::count(OWN.begin(), OWN.end(), entry->path().filename().u8string()) == 0)
            fs::remove(entry->path(), error);  // of an earlier version or a killed process
}

}  // namespace cv::iib
