// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#ifndef OPENCV_IIB_COMMON_DETECTOR_FILE_HPP
#define OPENCV_IIB_COMMON_DETECTOR_FILE_HPP

#include "../precomp.hpp"

namespace cv {
namespace iib {

/* The detector of an extractor in a file. Most detectors of OpenCV 4 write nothing of themselves, so the parameters of
 those that tell them are written here. SIFT tells none before OpenCV 4.8: it comes back with its defaults. */

//! Writes class and parameters as keys of the map that is open in `fs`.
void writeDetector(FileStorage& fs, const Feature2D& detector);

/** Creates the detector that writeDetector wrote. One of a class that is not OpenCV's own features2d cannot be created
 here: `present`, if it is of that class, reads the parameters and is returned, else a cv::Exception tells what to do. */
Ptr<Feature2D> readDetector(const FileNode& node, const Ptr<Feature2D>& present);

}  // namespace iib
}  // namespace cv

#endif
