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
    int partners;       //!< rows i < partners of both images are the same point; the others have no partner
    //! Where the rows' points are in the target, pixels; points nearer than 3 px are the same.
    std::vector<cv::Point2f> referencePoints, targetPoints;
    cv::Mat reference, target;  //!< CV_8U, a row a point
    float ratio;                //!< a match counts if it is nearer than this times the next one
};

//! Two images, and where points of the reference are in the target: behind the relief, if there is one, and then the homography.
struct Sample
{
    LoadedPair pair;
    cv::Ptr<Relief> relief;
};

//! The evaluation's fixed points; the sample has no relief.
DescribedPair describeFixed(
        const std::string& scene, const LoadedPair& pair, const cv::Ptr<cv::Feature2D>& extractor);

//! Points that HessianDetector finds in each image.
DescribedPair describeDetected(
        const std::string& scene, const Sample& sample, const cv::Ptr<cv::Feature2D>& extractor);

//! Where training images come from.
struct TrainingSet
{
    std::vector<ImagePair> pairs;
    std::vector<WalkPair> walks;  //!< for detected points alone
};

//! How training pairs are warped: about the target's centre, each number drawn anew for each pair.
struct Warps
{
    double share;              //!< of the pairs
    double sameLight;          //!< of these, those of one image and its own warp, without a change of light
    double degrees;            //!< turned by up to so many
    double smallest, largest;  //!< scale
    double tilt;               //!< up to which ratio of scales along two directions
    double perspective;        //!< change of scale from side to side, 0.1: by up to 10 %
    double gamma;              //!< from 1 / gamma to gamma
    double noise;              //!< standard deviation, up to so many grey values
};

//! Called with the work done so far and the whole of it.
typedef std::function<void(int done, int all)> Progress;

/** Random pairs of images of every scene, half of them mirrored, so that scenes count the same and left is like right.
Their points are the evaluation's fixed ones (up to 1000 FAST corners a pair, ROS of radius 32) or, in a share `detected`
of the pairs and in all walks, those that HessianDetector finds in each image by itself (up to 1000, with its scale
factor): partners agree within 2 pixels and by a factor of 1.5 in size. Pairs with fewer than 100 partners are left out. */
std::vector<DescribedPair> describeForTraining(const TrainingSet& images,
        const cv::Ptr<cv::Feature2D>& extractor, int pairsPerScene, double detected, const Warps& warps,
        uint64 seed, const Progress& progress);

}  // namespace iib_tools
