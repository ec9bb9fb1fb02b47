// SPDX-License-Identifier: Apache-2.0

#include "opencv2/iib/detail/output_folder.hpp"

#include <filesystem>

namespace cv::iib {

namespace fs = std::filesystem;

OutputFolder::OutputFolder(const std::string& folder, const std::function<bool(const std::string&)>& isOwn)
{
    const size_t end = checkedName(folder).find_last_not_of('/');  // a trailing slash would hide a link
    path_ = endOfLinks(end == std::string::npos ? folder : folder.substr(0, end + 1));
    const fs::path path = systemName(path_);
    std::error_code error, unknown;
    made_ = fs::create_directories(path, error);
    if (!fs::is_directory(path, unknown))
        CV_Error(Error::StsError,
                folder + " cannot be written: " + (error ? error.message() : "it is a file"));
    lock_ = std::make_unique<FileLock>(path_, FileLock::OUTPUT_FOLDER);
    error.clear();
    for (fs::recursive_directory_iterator entry(path, error), last; !error && entry != last;
            entry.increment(error))
    {
        const std::string name = entry->path().lexically_relative(path).generic_u8string();
        const fs::path file = entry->path().filename();
        const bool isOfFileManager = file == ".DS_Store" || file == "Thumbs.db" || file == "desktop.ini";
        if ((entry->is_symlink(unknown) || !entry->is_directory(unknown)) && !isOfFileManager && !isOwn(name))
            CV_Error(Error::StsError,
                    folder + " holds " + name + ", which no earlier run wrote: choose another folder");
    }
    if (error)
        CV_Error(Error::StsError, folder + " cannot be read: " + error.message());
    WholeFile probe(path_ + "/probe");  // a read-only folder must fail before any work is done
}

OutputFolder::~OutputFolder()
{
    std::error_code error;
    if (made_)
        fs::remove(systemName(path_), error);
}

}  // namespace cv::iib
