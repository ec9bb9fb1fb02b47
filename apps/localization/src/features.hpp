// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "opencv2/features2d.hpp"

namespace iib_localization {

//! What was found in one image; the strongest first within each detector.
struct Features
{
    std::vector<cv::Point2f> pixels;  //!< of all detectors, one after another
    std::vector<cv::Mat> codes;       //!< a matrix for each detector, a row for each of its pixels, CV_8U
};

/** Keypoints and how they are described and compared.
 - `iib`: the recommended chain, HessianDetector's keypoints and PRESET_UNIVERSAL
 - `own`: ORB's and AKAZE's keypoints on the locally normalized image, their own descriptors
 - `sift`: SIFT's keypoints on the locally normalized image, with Euclidean distances */
class FeatureMethod
{
public:
    //! @throws cv::Exception (StsBadArg) for another name.
    explicit FeatureMethod(const std::string& name);

    const std::string& name() const { return name_; }
    //! Tells methods apart whose descriptors cannot be compared.
    std::string description() const;
    size_t detectors() const { return detectors_.size(); }
    bool binary() const { return name_ != "sift"; }
    //! The ratio of distances, of the matches that tell which keyframe is the right one.
    float sureRatio() const { return name_ == "iib" ? 0.9f : 0.8f; }
    //! How many of the codes' columns tell keyframes apart: IIB's begin with the coarse cells.
    int coarseColumns(int columns) const { return name_ == "iib" ? columns / 2 : columns; }
    //! The ratio of the matches that a pose is found from: right ones of codes as long as IIB's reach it.
    float poseRatio() const { return name_ == "iib" ? 0.97f : 0.8f; }

    Features extract(const cv::Mat& grey) const;
    //! Mutual nearest neighbours, whose distance is less than maxRatio times the second nearest's.
    std::vector<cv::DMatch> match(const cv::Mat& query, const cv::Mat& train, float maxRatio) const;
    //! The same of two images: indices are those of their pixels.
    std::vector<cv::DMatch> match(const Features& a, const Features& b, float maxRatio) const;

private:
    std::string name_;
    std::vector<cv::Ptr<cv::Feature2D>> detectors_;
};

}  // namespace iib_localization
