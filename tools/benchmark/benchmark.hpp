// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "opencv2/features2d.hpp"
#include "opencv2/iib.hpp"

#include <functional>

namespace iib_tools {

struct Timed
{
    std::function<void()> run;
    int threads;
    int every;  //!< 1, or a long one's: only each so many-th round
};

/** Milliseconds of each task, least of all rounds. The rounds go through all tasks, so that a slow moment of the machine
meets them alike. */
std::vector<double> measure(const std::vector<Timed>& tasks, int rounds);

// Each measures its tasks and writes them.

//! What descriptors cost beside cv::ORB on the same keypoints.
void measureDescribing(cv::FileStorage& fs, int rounds);
/** What finding points and describing them costs, each method on its own points of a rendered picture, and what describing
the same points of AKAZE costs; on one thread. */
void measureChains(cv::FileStorage& fs, int rounds);
//! How the default descriptor's time grows with pixels beside ORB's, 1000 keypoints each, on one thread.
void measurePixels(cv::FileStorage& fs, int rounds);
//! What it costs to match an image's codes of 170 bytes with those of the same points under other light, on one thread.
void measureMatching(cv::FileStorage& fs, int rounds);
//! What small work costs, of which a video has much, and what a second thread brings.
void measureFrames(cv::FileStorage& fs, int rounds);

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
