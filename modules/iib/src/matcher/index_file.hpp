// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#pragma once

#include "parameters.hpp"

#include "opencv2/iib/detail/files.hpp"
#include "opencv2/iib/detail/packed_codes.hpp"

namespace cv { namespace iib {

/* Format 1 of an index, a checked file: u32: number of levels, each level's bytes, mode, cross-check; f32: maximal
ratio, each threshold; u64: number of images, each image's rows; the descriptors of all images. */

//! Writes the codes, their level sizes, and the other parameters.
void saveCodes(const String& filename, const MatcherParameters& parameters, const PackedCodes& codes);

//! Reads a file of saveCodes. @throws cv::Exception unless the file is whole and its parameters are valid.
Ptr<PackedCodes> loadCodes(const String& filename, MatcherParameters& parameters);

}}  // namespace cv::iib
