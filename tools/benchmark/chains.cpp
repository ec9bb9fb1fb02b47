// SPDX-License-Identifier: Apache-2.0

#include "benchmark.hpp"

#include "evaluation/configurations.hpp"
#include "opencv2/imgcodecs.hpp"

using namespace cv;
using cv::iib::IIB;

namespace iib_tools {
namespace {

const int POINTS = 1000;

//! What a program does with an image: finds points by itself and describes them.
struct Chain
{
    String name;
    Ptr<Feature2D> detector, descriptor;
};

Ptr<Feature2D> akaze() { return AKAZE::create(AKAZE::DESCRIPTOR_MLDB_UPRIGHT); }

std::vector<Chain> chains()
{
    const Ptr<Feature2D> orb = ORB::create(POINTS), brisk = BRISK::create(), sift = SIFT::create(POINTS),
                         kaze = KAZE::create(false, true), hessian = cv::iib::HessianDetector::create(POINTS);
    return {{"ORB", orb, orb}, {"BRISK", brisk, brisk}, {"AKAZE", akaze(), akaze()}, {"KAZE", kaze, kaze},
            {"SIFT", sift, sift}, {"IIB, points of ORB", orb, IIB::createFor(orb)},
            {"HessianDetector alone", hessian, Ptr<Feature2D>()},
            {"recommended chain", hessian, IIB::createFor(hessian, IIB::PRESET_UNIVERSAL)}};
}

//! What may describe AKAZE's points, each looking at about the same region.
std::vector<Chain> describers()
{
    std::vector<Chain> all = {{"IIB", akaze(), IIB::createFor(akaze())}, {"AKAZE", akaze(), akaze()},
            {"ORB", akaze(), ORB::create()}};
    for (const Configuration& c : baselineConfigurations())
        if (c.name == "BEBLID-512 5x")
            all.push_back({"BEBLID-512", akaze(), c.create()});
    return all;
}

std::vector<KeyPoint> strongest(const Ptr<Feature2D>& detector, const Mat& image)
{
    std::vector<KeyPoint> keypoints;
    detector->detect(image, keypoints);
    KeyPointsFilter::retainBest(keypoints, POINTS);
    return keypoints;
}

}  // namespace

std::vector<Timed> chainTasks()
{
    const Mat image = imread(IIB_PICTURE, IMREAD_GRAYSCALE);
    if (image.empty())
        CV_Error(Error::StsObjectNotFound, IIB_PICTURE ": cannot be read");
    const std::vector<KeyPoint> given = strongest(akaze(), image);
    std::vector<Timed> tasks;
    for (const Chain& chain : chains())
    {
        std::vector<KeyPoint> keypoints;
        Mat descriptors;
        chain.detector->detect(image, keypoints);
        tasks.push_back({"chain", chain.name, double(keypoints.size()), 1, 5, [=]() mutable {
                             if (chain.detector == chain.descriptor)
                                 chain.detector->detectAndCompute(image, noArray(), keypoints, descriptors);
                             else
                                 chain.detector->detect(image, keypoints);
                             if (chain.descriptor && chain.detector != chain.descriptor)
                                 chain.descriptor->compute(image, keypoints, descriptors);
                         }});
    }
    for (const Chain& chain : describers())
    {
        tasks.push_back(
                describing("same points", chain.name, double(given.size()), chain.descriptor, image, given));
        tasks.back().every = 5;
    }
    return tasks;
}

}  // namespace iib_tools
