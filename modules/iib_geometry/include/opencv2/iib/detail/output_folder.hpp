// SPDX-License-Identifier: Apache-2.0

#ifndef OPENCV_IIB_DETAIL_OUTPUT_FOLDER_HPP
#define OPENCV_IIB_DETAIL_OUTPUT_FOLDER_HPP

#include <functional>
#include <memory>
#include <string>

#include "opencv2/iib/detail/files.hpp"

namespace cv {
namespace iib {

//! @cond IGNORED

//! A folder that results are written to, by this module or the Python package; no other process writes results to it meanwhile.
class CV_EXPORTS OutputFolder
{
public:
    /** Makes the folder if it is missing. A link is followed, also if nothing is at its end yet.
    @param isOwn whether a file may be there, by its name relative to the folder: of earlier results. Empty folders may, and .DS_Store,
    Thumbs.db and desktop.ini, which file managers write.
    @throws cv::Exception if it holds anything else, cannot be written, or is being written by another process. */
    OutputFolder(const std::string& folder, const std::function<bool(const std::string&)>& isOwn);
    //! Removes the folder if it was made here and is empty.
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

}  // namespace iib
}  // namespace cv

#endif
