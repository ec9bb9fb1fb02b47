// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "common/dataset.hpp"
#include "opencv2/features2d.hpp"
#include "walks.hpp"

namespace iib_tools {

//! Points of two images of a scene, described with a whole candidate pool.
struct DescribedPair
{
    std::string scene;  //!< "set/sequence"
    int partners;  //!< rows i < partners of both images are the same point; the other rows have no partner
    //! The rows' points in pixels of the target; points nearer than 3 px are the same.
    std::vector<cv::Point2f> referencePoints, targetPoints;
    cv::Mat reference, target;  //!< CV_8U, one point a row
    float ratio;                //!< threshold of the ratio test
};

//! Two images; points of the reference map to the target by the relief, if there is one, then by the homography.
struct Sample
{
    LoadedPair pair;
    cv::Ptr<Relief> relief;
};

//! Describes the evaluation's fixed points; the sample has no relief.
DescribedPair describeFixed(
        const std::string& scene, const LoadedPair& pair, const cv::Ptr<cv::Feature2D>& extractor);

//! Describes the points of HessianDetector in each image.
DescribedPair describeDetected(
        const std::string& scene, const Sample& sample, const cv::Ptr<cv::Feature2D>& extractor);

//! The training images.
struct TrainingSet
{
    std::vector<ImagePair> pairs;
    std::vector<WalkPair> walks;  //!< used with detected points only
};

//! Random warps of training pairs about the target's centre, drawn independently for each pair.
struct Warps
{
    double share;              //!< of warped pairs
    double sameLight;          //!< share, among warped pairs, of an image with its own warp
    double degrees;            //!< largest rotation
    double smallest, largest;  //!< scale
    double tilt;               //!< largest ratio of scales along two directions
    double perspective;        //!< largest change of scale from side to side; 0.1 is 10 %
    double gamma;              //!< from 1 / gamma to gamma
    double noise;              //!< largest standard deviation, grey values
};

//! Called with the number of finished steps and of all steps.
typedef std::function<void(int done, int all)> Progress;

/** Describes random pairs of images: equally many of each scene, so that scenes have equal weight, and half of them
mirrored, so that left and right do. Pairs with fewer than 100 partners are left out.
- Fixed points are those of the evaluation: up to 1000 FAST corners a pair, with a ROS of radius 32.
- Detected points are used in a share `detected` of the pairs and in all walks: up to 1000 by HessianDetector in each
  image, with its
  scale factor. Partners agree within 2 pixels and within a factor of 1.5 in size. */
std::vector<DescribedPair> describeForTraining(const TrainingSet& images,
        const cv::Ptr<cv::Feature2D>& extractor, int pairsPerScene, double detected, const Warps& warps,
        uint64 seed, const Progress& progress);

}  // namespace iib_tools
