// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

namespace iib_localization {

struct ImageFile
{
    std::string path;
    std::string file;  //!< without the folder
    std::string name;  //!< also without extension
};

/** The images of a folder by name.
@throws cv::Exception if there is none, or for a name that the files of results cannot hold: with blanks, commas or quotes,
with a leading #, or equal to another but for the extension. */
std::vector<ImageFile> listImages(const std::string& folder);

}  // namespace iib_localization
