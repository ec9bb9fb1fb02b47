// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "opencv2/core.hpp"
#include "opencv2/core/types.hpp"

namespace iib_tools {

//! Scene points in both images; reference[i] and target[i] are the same point.
struct SeedPoints
{
    std::vector<cv::KeyPoint> reference, target;
};

/** At most `count` keypoints spread evenly over the list: elements i * size / count. Of corners in raster order, as
from FAST, this samples all parts of the image equally. */
std::vector<cv::KeyPoint> sampleUniformly(const std::vector<cv::KeyPoint>& keypoints, int count);

/** Fixed points (paper, "Experiments Using Predefined Feature Points with ROS"): projects the reference's
points and samples `count` of those whose ROS, a square of side 2 * radius about the centre, lies inside both
images. Angles become -1. KeyPoint::response is the index of the seed, which identifies points after descriptors drop or
reorder them. */
SeedPoints projectSeeds(const std::vector<cv::KeyPoint>& reference, const cv::Matx33d& homography,
        cv::Size referenceSize, cv::Size targetSize, float radius, int count);

/** FAST corners (size 7) in raster order. The threshold starts at 20 and is halved while fewer than `count` corners
have their ROS inside the image, so that dark images give points too. */
std::vector<cv::KeyPoint> fastCorners(const cv::Mat& image, float radius, int count);

//! projectSeeds of the reference's fastCorners, KeyPoint::size 2 * radius: use a scale factor of 1.
SeedPoints fastSeeds(const cv::Mat& reference, const cv::Mat& target, const cv::Matx33d& homography,
        float radius, int count);

//! Sets every angle to the direction from the centre to the intensity centroid of a disc, degrees clockwise.
void orientByCentroid(const cv::Mat& image, float radius, std::vector<cv::KeyPoint>& keypoints);

/** Reads lines `x,y,size,angle,response` (pixels; degrees or -1) after a header line. Either all lines go on with the
numbers of a descriptor, which becomes a row of CV_32F, or none does, and `descriptors` stays empty.
@throws cv::Exception with file and line for anything else. */
void readKeypoints(const std::string& file, std::vector<cv::KeyPoint>& keypoints, cv::Mat& descriptors);

}  // namespace iib_tools
