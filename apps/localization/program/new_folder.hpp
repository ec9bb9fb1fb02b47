// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

namespace iib_localization {

/** A folder of results that appears whole: its files are written to `TARGET.iib_partial`, which publish() moves to TARGET.
What is at TARGET is replaced only if it is empty or holds nothing but such results. */
class NewFolder
{
public:
    /** Makes the folder to write to; what a run that was killed left there is removed.
    @param ownFiles patterns (fnmatch) of the names in it, of folders with a slash behind; a folder without the first is none of
    these.
    @throws cv::Exception if TARGET may not be replaced or another process is writing it. */
    NewFolder(const std::string& target, const std::vector<std::string>& ownFiles);
    ~NewFolder();  //!< removes what was not published
    NewFolder(const NewFolder&) = delete;
    NewFolder& operator=(const NewFolder&) = delete;

    //! Where to write until then.
    const std::string& path() const { return partial_; }
    //! Readers see the whole old folder, the whole new one, or for a moment none. @throws cv::Exception if it cannot be moved.
    void publish();

private:
    std::string target_, partial_;
    int lock_ = -1;
};

}  // namespace iib_localization
