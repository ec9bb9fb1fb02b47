// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "rays.hpp"

namespace iib_localization {

/** Places what the keypoints of a map's images see. The surest links first join rays to tracks, which hold one ray of an image
and see one point at most; keypoints that see no point yet are moved to what one of their track shows, the reference.
The rays farthest from a track's point are left out until the others agree; it has none if too few do, or look from nearly
the same direction. */
void triangulate(Map& map, const std::vector<Ray>& rays, const std::vector<Link>& links);

}  // namespace iib_localization
