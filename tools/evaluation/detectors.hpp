// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
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
    std::string folder;                 //!< of lists of keypoints, one per image; empty: detects in the image
    std::vector<std::string> only;      //!< what its points are described by; empty: by all

    //! Whether it has keypoints of the image of this file.
    bool knows(const std::string& imageFile) const;
};

/** FAST, AGAST (both with ORB's descriptor), ORB, BRISK, AKAZE, KAZE, SIFT, the same seven on the locally normalized image ("ORB
normalized"), HessianDetector, and SURF if it was built, limited by Options::detectors; then those of Options::keypoints, named by
their folders. Each finds at most the Options::points strongest keypoints.
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

/** Describes the detector's points of an image, in the same order for every image: by its own descriptor if it has one, those of
Detector::others, IIB's presets, and last IIB's default. Detector::only limits them. */
std::vector<Described> describeAll(const Detector& detector, const cv::Mat& image, const std::string& file);

/** Keeps the results of describeAll for the last images, since an image occurs in several pairs and describing takes most of an
experiment's time. Safe to use from several threads. */
class DescribedImages
{
public:
    typedef std::shared_ptr<const std::vector<Described>> Result;

    //! @param most images of one detector each, of about a megabyte
    explicit DescribedImages(size_t most = 200) : most_(most) {}

    //! A changed image needs another file name. Two threads that ask for the same image at once may both describe it.
    Result get(const Detector& detector, const cv::Mat& image, const std::string& file);

private:
    typedef std::pair<std::string, std::string> Key;  // detector, file

    size_t most_;
    std::map<Key, Result> known_;
    std::deque<Key> order_;  // oldest first
    std::mutex mutex_;
};

}  // namespace iib_tools
