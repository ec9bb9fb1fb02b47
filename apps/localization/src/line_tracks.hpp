// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#ifndef IIB_LOCALIZATION_LINE_TRACKS_HPP
#define IIB_LOCALIZATION_LINE_TRACKS_HPP

#include "colmap_model.hpp"
#include "line_features.hpp"
#include "line_map.hpp"

namespace iib_localization {

/** Lines that keyframes with known poses see: segments of two keyframes near each other whose codes are nearest make a
line, where the planes through the cameras and the segments cross; it stays if three keyframes or more see it.
@param features of each keyframe of the model. */
LineMap triangulateLines(const std::vector<LineFeatures>& features, const Model& model);

}  // namespace iib_localization

#endif
