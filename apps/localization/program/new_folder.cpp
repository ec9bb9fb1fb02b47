// SPDX-License-Identifier: Apache-2.0

#include "new_folder.hpp"

#include <fcntl.h>
#include <fnmatch.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
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
        seen = entry.path().lexically_relative(folder).string();
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

//! A mount point cannot be moved.
bool isMountPoint(const std::string& folder)
{
    struct stat own, parent;
    return ::stat(folder.c_str(), &own) == 0 && ::stat((folder + "/..").c_str(), &parent) == 0 &&
           own.st_dev != parent.st_dev;
}

}  // namespace

NewFolder::NewFolder(const std::string& target, const std::vector<std::string>& ownFiles)
{
    try
    {
        const fs::path path = fs::weakly_canonical(target);
        target_ = (path.has_filename() ? path : path.parent_path()).string();  // without a slash at its end
        partial_ = target_ + ".iib_partial";
        if (isMountPoint(target_))
            fail(target + " is a mount point: give a folder inside it");
        if (fs::exists(target_))
            checkContents(target_, ownFiles);
        fs::create_directories(partial_);
        lock_ = ::open(partial_.c_str(), O_RDONLY | O_CLOEXEC);
        if (lock_ < 0 || ::flock(lock_, LOCK_EX | LOCK_NB) != 0)
        {
            ::close(lock_);
            lock_ = -1;
            fail(target + " is being written by another process: wait until it has ended");
        }
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
    const bool moved = fs::exists(target_, error) ? ::renameat2(AT_FDCWD, partial_.c_str(), AT_FDCWD,
                                                            target_.c_str(), RENAME_EXCHANGE) == 0
                                                  : std::rename(partial_.c_str(), target_.c_str()) == 0;
    if (!moved)
        fail(target_ + " cannot be replaced by " + partial_);
    fs::remove_all(partial_, error);  // what was at the target before
    partial_.clear();
}

}  // namespace iib_localization
