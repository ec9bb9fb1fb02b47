// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#ifndef IIB_TOOLS_DETECTORS_HPP
#define IIB_TOOLS_DETECTORS_HPP

#include <functional>
#include <string>
#include <vector>

#include "configurations.hpp"
#include "experiments.hpp"

namespace iib_tools {

//! Keypoints, upright, and the detector's own descriptors of them, one row each, if it has any.
struct Detection
{
    std::vector<cv::KeyPoint> keypoints;
    cv::Mat descriptors;
    int norm;
};

//! A detector of the experiment with detected points (paper, "Experiments Combined with Feature Detectors").
struct Detector
{
    std::string name;
    std::string descriptor;  //!< name of its own descriptor, empty if there is none to compare with
    float scaleFactor;       //!< of IIB on its keypoints
    //! From an 8-bit grey image, the pair it belongs to and the image's file.
    std::function<Detection(const cv::Mat&, const ImagePair&, const std::string&)> detect;
};

/** FAST, AGAST (both with ORB's descriptor), ORB, BRISK, AKAZE, KAZE, SIFT, SURF where present, keypoints from
files and from a network where the options name them. Each gives at most Options::points keypoints, the
strongest. */
std::vector<Detector> detectors(const Options& options);

}  // namespace iib_tools

#endif
