// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "map.hpp"
#include "opencv2/iib/detail/output_folder.hpp"

namespace cv::iib {

//! The locked folder of a map.
class MapFolder
{
public:
    //! @throws cv::Exception if the folder holds anything but a map, cannot be made, or another process has locked it.
    explicit MapFolder(const std::string& folder);

    /** Writes the map's file and, for other programs, a COLMAP model. Concurrent readers get the old map or the new
    one.
    @throws cv::Exception if the map cannot be written; the old map then stays. */
    void write(Map map) const;

private:
    std::vector<std::string> leftovers_;  // unfinished files of a killed process
    const OutputFolder folder_;
};

}  // namespace cv::iib
