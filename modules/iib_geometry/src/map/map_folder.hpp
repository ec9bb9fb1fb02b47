// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "map.hpp"
#include "opencv2/iib/detail/output_folder.hpp"

namespace cv::iib {

//! A folder that a map is written to; no other process can write it meanwhile.
class MapFolder
{
public:
    //! @throws cv::Exception if the folder holds anything but a map, cannot be made, or is locked.
    explicit MapFolder(const std::string& folder);

    /** Writes the map's file and, for other programs, a COLMAP model. Who reads the map meanwhile gets the old one or the new.
    @throws cv::Exception if it cannot be written; the old map stays then. */
    void write(const Map& map) const;

private:
    std::vector<std::string> replaced_;  // files that a killed process has left
    const OutputFolder folder_;
};

}  // namespace cv::iib
