// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#pragma once

#include "../precomp.hpp"

namespace cv { namespace iib {

/* The detector of an extractor in a file. HessianDetector, NormalizedDetector and ORB, whose write() stores nothing, are stored
 completely. For others the file has the class name and the output of write(). */

//! Writes class and parameters as keys of the map that is open in `fs`.
void writeDetector(FileStorage& fs, const Feature2D& detector);

/** Creates the ORB, HessianDetector or NormalizedDetector of a file. For any other class, `present` must be of this class: it
 reads the parameters and is returned. @throws cv::Exception (StsParseError) that says what to do. */
Ptr<Feature2D> readDetector(const FileNode& node, const Ptr<Feature2D>& present);

}}  // namespace cv::iib
