// SPDX-License-Identifier: Apache-2.0

#ifndef OPENCV_IIB_DETAIL_OUTPUT_FOLDER_HPP
#define OPENCV_IIB_DETAIL_OUTPUT_FOLDER_HPP

#include <functional>
#include <memory>
#include <string>

#include "opencv2/iib/detail/files.hpp"

namespace cv { namespace iib {

//! @cond IGNORED

//! A folder of results of this module or the Python package, locked against other processes that write results.
class CV_EXPORTS OutputFolder
{
public:
    /** Makes the folder if it is missing. Follows a link, even one whose target does not exist yet.
    @param isOwn whether a file belongs to earlier results, by its name relative to the folder. Empty folders and the
    files of file managers (.DS_Store, Thumbs.db, desktop.ini) are accepted too.
    @throws cv::Exception if it holds anything else, cannot be written, or is being written by another process. */
    OutputFolder(const std::string& folder, const std::function<bool(const std::string&)>& isOwn);
    //! Removes the folder if this object made it and it is empty.
    ~OutputFolder();
    OutputFolder(const OutputFolder&) = delete;
    OutputFolder& operator=(const OutputFolder&) = delete;

    const std::string& path() const { return path_; }

private:
    std::string path_;
    bool made_ = false;
    std::unique_ptr<FileLock> lock_;
};

//! @endcond

}}  // namespace cv::iib

#endif
