// SPDX-License-Identifier: Apache-2.0

#include "output_folder.hpp"

#include <algorithm>
#include <filesystem>

namespace cv::iib {

namespace fs = std::filesystem;

OutputFolder::OutputFolder(const std::string& folder, const std::vector<std::string>& marks,
        const std::function<bool(const std::string&)>& isOwn)
{
    const size_t end =
            checkedName(folder).find_last_not_of('/');  // a slash behind a link would be a folder's
    path_ = endOfLinks(end == std::string::npos ? folder : folder.substr(0, end + 1));
    std::error_code error, unknown;
    made_ = fs::create_directories(systemName(path_), error);
    if (!fs::is_directory(systemName(path_), unknown))
        CV_Error(Error::StsError,
                folder + " cannot be written: " + (error ? error.message() : "it is a file"));
    lock_ = std::make_unique<FileLock>(path_, FileLock::REFUSE);
    check(marks, isOwn);
    WholeFile probe(path_ + "/" + marks[0]);  // what cannot be written is told before there is work to lose
}

OutputFolder::~OutputFolder()
{
    std::error_code error;
    if (made_)
        fs::remove(systemName(path_), error);
}

void OutputFolder::check(
        const std::vector<std::string>& marks, const std::function<bool(const std::string&)>& isOwn) const
{
    std::error_code error;
    std::string any;
    bool marked = false;
    for (fs::recursive_directory_iterator entry(systemName(path_), error), end; !error && entry != end;
            entry.increment(error))
    {
        any = entry->path().lexically_relative(systemName(path_)).generic_u8string();
        marked = marked || std::count(marks.begin(), marks.end(), any) != 0;
        const bool isFolder = !entry->is_symlink(error) && entry->is_directory(error);
        if (isFolder ? isOwn(any + "/") : isOwn(any))
            continue;
        CV_Error(Error::StsError,
                path_ + " holds " + any + ", which is of no earlier run: choose another folder");
    }
    if (error)
        CV_Error(Error::StsError, path_ + " cannot be read: " + error.message());
    if (!any.empty() && !marked)
        CV_Error(
                Error::StsError, path_ + " holds " + any + " and no " + marks[0] + ": choose another folder");
}

}  // namespace cv::iib
