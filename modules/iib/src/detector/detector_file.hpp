// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#pragma once

#include "../precomp.hpp"

namespace cv { namespace iib {

/* The detector of an extractor in a file. Files hold HessianDetector, NormalizedDetector and ORB, which create()
 starts with and which writes nothing of itself; of others they hold the name, and what those write themselves. */

//! Writes class and parameters as keys of the map that is open in `fs`.
void writeDetector(FileStorage& fs, const Feature2D& detector);

/** Creates the ORB, HessianDetector or NormalizedDetector that writeDetector wrote. For any other class `present` must
 be of it: it reads the parameters and is returned. @throws cv::Exception (StsParseError) that tells what to do. */
Ptr<Feature2D> readDetector(const FileNode& node, const Ptr<Feature2D>& present);

}}  // namespace cv::iib
