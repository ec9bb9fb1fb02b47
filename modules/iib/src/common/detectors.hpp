// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#pragma once

#include "../precomp.hpp"

namespace cv {
namespace iib {

/** An image as a detector takes it, to find keypoints or to describe them: 8U as it is; 16U and 32F, which most detectors of
 OpenCV refuse or read wrongly, as 8-bit grey from the image's own minimum to its maximum. Detectors of this library take
 all types. Throws as checkImage(). */
Mat imageFor(const Feature2D& detector, const Mat& image);

/** A detection's mask with 255 where it is not 0: detectors that scale it would lose a 1.
 @throws cv::Exception unless it is empty or CV_8UC1 of the image's size. */
Mat maskFor(InputArray mask, Size imageSize);

/* The detector of an extractor in a file. Files hold HessianDetector, NormalizedDetector and ORB, which create()
 starts with and which writes nothing of itself; of others they hold the name, and what those write themselves. */

//! Writes class and parameters as keys of the map that is open in `fs`.
void writeDetector(FileStorage& fs, const Feature2D& detector);

/** Creates the ORB, HessianDetector or NormalizedDetector that writeDetector wrote. For any other class `present` must be of it: it reads
 the parameters and is returned. @throws cv::Exception (StsParseError) that tells what to do if it is not. */
Ptr<Feature2D> readDetector(const FileNode& node, const Ptr<Feature2D>& present);

}  // namespace iib
}  // namespace cv
