// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "colmap_model.hpp"
#include "line_map.hpp"
#include "new_folder.hpp"

namespace iib_localization {

/** Where a camera can find itself: keyframes, the points seen in them, and a code for each sight of a point.

On disk it is a folder: COLMAP's text model, `codes_D.iib` (the index file of cv::iib::HierarchicalMatcher) for detector
D, with lines also `lines3D.txt` and `codes_lines.iib`, and `map.txt` with the way the codes were made and a hash of each
of the files. */
struct Map
{
    Model model;
    std::string features;     //!< name of the FeatureMethod
    std::string description;  //!< and its description
    std::vector<std::vector<cv::Mat>>
            codes;  //!< [keyframe][detector]; rows are the keyframe's pixels, in their order
    LineMap lines;  //!< may be empty

    //! All codes in bytes.
    size_t codeBytes() const;
    //! Points and where they are seen, in bytes.
    size_t pointBytes() const;
};

//! Where a map can be written, also in place of an old one. @throws cv::Exception if `folder` holds anything else.
NewFolder placeOfMap(const std::string& folder);
//! Writes a map and publishes it. @throws cv::Exception if it cannot be written.
void writeMap(NewFolder&& place, const Map& map);
//! @throws cv::Exception for what is no map, or a damaged one.
Map readMap(const std::string& folder);

}  // namespace iib_localization
