// SPDX-License-Identifier: Apache-2.0

#include "new_folder.hpp"

#include <fcntl.h>
#include <fnmatch.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>

#include "opencv2/core.hpp"

namespace iib_localization {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void fail(const std::string& what) { CV_Error(cv::Error::StsError, what); }

//! Throws unless the folder may be replaced.
void checkContents(const std::string& folder, const std::vector<std::string>& ownFiles)
{
    std::string seen;
    bool known = false, foreign = false;
    for (const auto& entry : fs::recursive_directory_iterator(folder))
    {
        seen = entry.path().lexically_relative(folder).string() + (entry.is_directory() ? "/" : "");
        const auto isName = [&](const std::string& pattern) {
            return ::fnmatch(pattern.c_str(), seen.c_str(), 0) == 0;
        };
        known = known || isName(ownFiles[0]);
        foreign = std::none_of(ownFiles.begin(), ownFiles.end(), isName);
        if (foreign)
            break;
    }
    if (foreign || (!known && !seen.empty()))
        fail(folder + " holds " + seen + " and was not written by this program: choose another folder");
}

//! A mount point cannot be moved, also not one of a folder of the same file system.
bool isMountPoint(const std::string& folder)
{
    struct stat own, parent;
    if (::stat(folder.c_str(), &own) == 0 && ::stat((folder + "/..").c_str(), &parent) == 0 &&
            own.st_dev != parent.st_dev)
        return true;
#ifdef STATX_ATTR_MOUNT_ROOT
    struct statx status;
    return ::statx(AT_FDCWD, folder.c_str(), 0, 0, &status) == 0 &&
           (status.stx_attributes & STATX_ATTR_MOUNT_ROOT) != 0;
#else
    return false;
#endif
}

}  // namespace

NewFolder::NewFolder(const std::string& target, const std::vector<std::string>& ownFiles)
{
    try
    {
        const fs::path path = fs::weakly_canonical(target);
        target_ = (path.has_filename() ? path : path.parent_path()).string();  // without a slash at its end
        partial_ = target_ + ".iib_partial";
        for (const std::string& link : {target_, partial_})  // the target only if it leads nowhere
            if (fs::is_symlink(link))
                fail(link + " is a link" + (link == target_ ? " to nothing" : "") + ": remove it");
        if (isMountPoint(target_))
            fail(target + " is a mount point: give a folder inside it");
        if (fs::exists(target_))
            checkContents(target_, ownFiles);
        fs::create_directories(partial_);
        lock_ = ::open(partial_.c_str(), O_RDONLY | O_CLOEXEC);
        if (::flock(lock_, LOCK_EX | LOCK_NB) != 0)
            fail(target + " is being written by another process: wait until it has ended");
        for (const auto& entry : fs::directory_iterator(partial_))
            fs::remove_all(entry.path());
    }
    catch (const fs::filesystem_error& e)
    {
        fail(target + " cannot be written: " + e.code().message());
    }
}

NewFolder::~NewFolder()
{
    std::error_code error;
    if (!partial_.empty())
        fs::remove_all(partial_, error);
    if (lock_ >= 0)
        ::close(lock_);
}

void NewFolder::publish()
{
    std::error_code error;
    const std::string partial = partial_, old = partial + ".old";
    partial_.clear();  // is not removed any more
    if (fs::exists(target_, error))
    {
        fs::remove_all(old, error);  // of a killed run
        fs::rename(target_, old, error);
    }
    fs::rename(partial, target_, error);
    if (error)
    {
        fs::rename(old, target_, error);
        fail(target_ + " cannot be replaced: the results are in " + partial);
    }
    fs::remove_all(old, error);
}

}  // namespace iib_localization
