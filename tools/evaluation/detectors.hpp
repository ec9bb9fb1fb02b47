// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "configurations.hpp"
#include "experiments.hpp"

namespace iib_tools {

//! Upright keypoints, and the detector's own descriptors, one row each; empty without a descriptor.
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
    std::string descriptor;  //!< name of its own descriptor, or empty
    float scaleFactor;       //!< of IIB on its keypoints
    //! Arguments: an 8-bit grey image, and the name of its file.
    std::function<Detection(const cv::Mat&, const std::string&)> detect;
    std::vector<Configuration> others;  //!< other descriptors of the same points
    std::string folder;                 //!< of lists of keypoints, one per image; empty: detects in the image

    //! Whether it has keypoints of an image.
    bool knows(const std::string& imageFile) const;
};

/** The detectors of the experiments, limited by Options::detectors:
- FAST and AGAST (both with ORB's descriptor), ORB, BRISK, AKAZE, KAZE and SIFT;
- the same seven on the locally normalized image ("ORB normalized");
- HessianDetector, and SURF if it was built;
- those of Options::keypoints, named by their folders.

Each finds at most the Options::points strongest keypoints.
@throws cv::Exception for an unknown name. */
std::vector<Detector> detectors(const Options& options);

//! The keypoints of an image that a descriptor kept, and their descriptors.
struct Described
{
    std::string name;
    std::vector<cv::KeyPoint> keypoints;
    cv::Mat descriptors;
    int norm, bytes;
};

/** Describes a detector's points in an image, by the same descriptors in the same order for every image: its own, Detector::others,
IIB's presets, and last IIB's default. */
std::vector<Described> describeAll(const Detector& detector, const cv::Mat& image, const std::string& file);

}  // namespace iib_tools
