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

void measureChains(FileStorage& fs, int rounds)
{
    const Mat image = imread(IIB_PICTURE, IMREAD_GRAYSCALE);
    if (image.empty())
        CV_Error(Error::StsObjectNotFound, IIB_PICTURE ": cannot be read");
    const std::vector<Chain> whole = chains(), same = describers();
    const std::vector<KeyPoint> given = strongest(akaze(), image);
    std::vector<Timed> tasks;
    Mat descriptors;
    for (const Chain& chain : whole)
        tasks.push_back({[&, chain] {
                             std::vector<KeyPoint> keypoints;
                             if (chain.detector == chain.descriptor)
                                 chain.detector->detectAndCompute(image, noArray(), keypoints, descriptors);
                             else
                                 chain.detector->detect(image, keypoints);
                             if (chain.descriptor && chain.detector != chain.descriptor)
                                 chain.descriptor->compute(image, keypoints, descriptors);
                         },
                1, 5});
    for (const Chain& chain : same)
        tasks.push_back({[&, chain] {
                             std::vector<KeyPoint> keypoints = given;
                             chain.descriptor->compute(image, keypoints, descriptors);
                         },
                1, 5});
    const std::vector<double> milliseconds = measure(tasks, rounds);
    fs << "chains"
       << "[";
    for (size_t i = 0; i < whole.size(); i++)
    {
        std::vector<KeyPoint> keypoints;
        whole[i].detector->detect(image, keypoints);
        fs << "{"
           << "name" << whole[i].name << "points" << int(keypoints.size()) << "milliseconds"
           << milliseconds[i] << "}";
    }
    fs << "]"
       << "same_points"
       << "[";
    for (size_t i = 0; i < same.size(); i++)
        fs << "{"
           << "name" << same[i].name << "points" << int(given.size()) << "milliseconds"
           << milliseconds[whole.size() + i] << "}";
    fs << "]";
}

}  // namespace iib_tools
