// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "opencv2/features2d.hpp"
#include "opencv2/iib.hpp"

#include <functional>

namespace iib_tools {

//! What is measured, and how the JSON calls it.
struct Timed
{
    cv::String what, name;
    double size;  //!< points, codes on either side, or megapixels
    int threads;
    int every;  //!< 1, or a long one's: only each so many-th round
    std::function<void()> run;
};

//! Describing keypoints of an image, with maps of it for an IIB extractor of further channels.
Timed describing(const cv::String& what, const cv::String& name, double size,
        const cv::Ptr<cv::Feature2D>& feature, const cv::Mat& image, const std::vector<cv::KeyPoint>& given,
        int threads = 1, const std::vector<cv::Mat>& maps = std::vector<cv::Mat>());

//! What descriptors cost beside cv::ORB on the same keypoints: "describe".
std::vector<Timed> describingTasks();
//! How the default descriptor's time grows with pixels beside ORB's, 1000 keypoints each: "megapixels".
std::vector<Timed> pixelTasks();
/** What finding points and describing them costs, each method on its own points of a rendered picture, "chain", and what
describing the same points of AKAZE costs, "same points". */
std::vector<Timed> chainTasks();
//! What it costs to match an image's codes of 170 bytes with those of the same points in other light: "match", "cross-check".
std::vector<Timed> matchingTasks();
//! What small work costs, of which a video has much, and what a second thread brings: "frame".
std::vector<Timed> frameTasks();

//! A grey image with corners everywhere: blurred noise at two scales.
cv::Mat cornerImage(cv::Size size);

//! The scene at another time: darker, with a ramp of light and noise.
cv::Mat relit(const cv::Mat& image);

//! FAST corners, spread over the image, with ORB's size, away from the border, where ORB would drop them.
std::vector<cv::KeyPoint> corners(const cv::Mat& image, size_t count);

//! The descriptors of the keypoints, of which those that the extractor drops are missing.
cv::Mat described(
        const cv::Ptr<cv::Feature2D>& extractor, const cv::Mat& image, std::vector<cv::KeyPoint> keypoints);

}  // namespace iib_tools
