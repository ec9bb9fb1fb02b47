// SPDX-License-Identifier: Apache-2.0
#pragma once

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

//! A detector of the experiments with detected points (paper, "Experiments Combined with Feature Detectors").
struct Detector
{
    std::string name;
    std::string descriptor;  //!< name of its own descriptor, empty if there is none to compare with
    float scaleFactor;       //!< of IIB on its keypoints
    //! From an 8-bit grey image and the name of its file.
    std::function<Detection(const cv::Mat&, const std::string&)> detect;
    std::vector<Configuration> others;  //!< of other makers, described at the same points
    std::string folder;                 //!< of lists of keypoints, one an image; empty: it looks at the image
    std::vector<std::string> only;      //!< what its points are described by; empty: by all

    //! Whether it has keypoints of the image of this file.
    bool knows(const std::string& imageFile) const;
};

/** FAST, AGAST (both with ORB's descriptor), ORB, BRISK, AKAZE, KAZE, SIFT, the same seven on the locally normalized
image ("ORB normalized"), HessianDetector, SURF if it was built; of these the ones that Options::detectors names; and those
of Options::keypoints, by their folders' names. Each gives at most Options::points keypoints, the strongest.
@throws cv::Exception for an unknown name. */
std::vector<Detector> detectors(const Options& options);

//! One image's keypoints, those that a descriptor kept, and their descriptors.
struct Described
{
    std::string name;
    std::vector<cv::KeyPoint> keypoints;
    cv::Mat descriptors;
    int norm, bytes;
};

/** What describes the detector's points of an image: its own descriptors if it has some, those of Detector::others, IIB's presets and last IIB's default: in
the same order for every image of a detector; of these Detector::only alone where it names some. */
std::vector<Described> describeAll(const Detector& detector, const cv::Mat& image, const std::string& file);

}  // namespace iib_tools
