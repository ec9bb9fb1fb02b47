// SPDX-License-Identifier: Apache-2.0

#include "samples.hpp"

#include <cmath>
#include <map>

#include "opencv2/imgcodecs.hpp"
#include "opencv2/imgproc.hpp"

namespace iib_tools {
namespace {

const int FEWEST_POINTS = 100;

cv::Matx33d rotation(double radians)
{
    const double c = std::cos(radians), s = std::sin(radians);
    return cv::Matx33d(c, -s, 0, s, c, 0, 0, 0, 1);
}

double logUniform(cv::RNG& rng, double low, double high)
{
    return std::exp(rng.uniform(std::log(low), std::log(high)));
}

std::string sceneOf(const ImagePair& pair) { return pair.set + "/" + pair.sequence; }

//! Two random images of a scene; in a third of the cases the reference and a target.
LoadedPair drawPair(const std::vector<ImagePair>& scene, cv::RNG& rng)
{
    const int first = rng.uniform(0, int(scene.size())), second = rng.uniform(0, int(scene.size()));
    LoadedPair pair = loadPair(scene[second]);
    if (first != second && rng.uniform(0, 3) != 0)
    {
        const LoadedPair other = loadPair(scene[first]);
        pair.reference = other.target;
        pair.homography = pair.homography * other.homography.inv();
    }
    return pair;
}

void mirror(Sample& sample)
{
    LoadedPair& pair = sample.pair;
    cv::flip(pair.reference, pair.reference, 1);
    cv::flip(pair.target, pair.target, 1);
    if (sample.relief)
        return sample.relief->mirror();
    const cv::Matx33d flipReference(-1, 0, pair.reference.cols - 1., 0, 1, 0, 0, 0, 1);
    const cv::Matx33d flipTarget(-1, 0, pair.target.cols - 1., 0, 1, 0, 0, 0, 1);
    pair.homography = flipTarget * pair.homography * flipReference;
}

Sample drawWalk(const std::vector<WalkPair>& scene, cv::RNG& rng)
{
    const WalkPair& drawn = scene[size_t(rng.uniform(0, int(scene.size())))];
    Sample sample;
    sample.pair.reference = readImage(drawn.referenceFile);
    sample.pair.target = readImage(drawn.targetFile);
    sample.pair.homography = cv::Matx33d::eye();
    sample.relief = cv::makePtr<Relief>(loadRelief(drawn));
    return sample;
}

void makeSelfPair(Sample& sample)
{
    sample.pair.target = sample.pair.reference;
    sample.pair.homography = cv::Matx33d::eye();
    sample.relief.release();
}

//! Changes an image by a gamma curve and noise.
void changeGrey(cv::Mat& image, const Warps& warps, cv::RNG& rng)
{
    const double gamma = logUniform(rng, 1 / warps.gamma, warps.gamma);
    cv::Mat_<uchar> table(1, 256);
    for (int i = 0; i < 256; i++)
        table(i) = cv::saturate_cast<uchar>(255 * std::pow(i / 255., gamma));
    cv::LUT(image, table, image);
    cv::Mat noise(image.size(), CV_16S);
    rng.fill(noise, cv::RNG::NORMAL, 0., rng.uniform(0., warps.noise));
    cv::add(image, noise, image, cv::noArray(), CV_8U);
}

void warpTarget(LoadedPair& pair, const Warps& warps, cv::RNG& rng)
{
    const double angle = rng.uniform(-warps.degrees, warps.degrees) * CV_PI / 180,
                 scale = logUniform(rng, warps.smallest, warps.largest);
    const double tilt = std::sqrt(logUniform(rng, 1 / warps.tilt, warps.tilt)),
                 tiltAxis = rng.uniform(0., CV_PI);
    const double x = pair.target.cols / 2., y = pair.target.rows / 2.;
    const cv::Matx33d toCentre(1, 0, -x, 0, 1, -y, 0, 0, 1), back(1, 0, x, 0, 1, y, 0, 0, 1);
    const cv::Matx33d stretch(tilt * scale, 0, 0, 0, scale / tilt, 0, 0, 0, 1);
    cv::Matx33d bend = cv::Matx33d::eye();
    if (warps.perspective > 0)
    {
        bend(2, 0) = rng.uniform(-warps.perspective, warps.perspective) / pair.target.cols;
        bend(2, 1) = rng.uniform(-warps.perspective, warps.perspective) / pair.target.rows;
    }
    const cv::Matx33d warp =
            back * bend * rotation(tiltAxis) * stretch * rotation(angle - tiltAxis) * toCentre;

    cv::Mat source = pair.target.clone();  // the target may share the reference's pixels
    if (scale < 1)                         // against aliasing
        cv::GaussianBlur(source, source, cv::Size(), 0.4 / scale);
    cv::Mat warped;
    cv::warpPerspective(source, warped, warp, source.size(), cv::INTER_LINEAR, cv::BORDER_REFLECT);
    pair.target = warped;
    pair.homography = warp * pair.homography;
    if (warps.noise > 0)
        changeGrey(pair.target, warps, rng);
}

}  // namespace

std::vector<DescribedPair> describeForTraining(const TrainingSet& images,
        const cv::Ptr<cv::Feature2D>& extractor, int pairsPerScene, double detected, const Warps& warps,
        uint64 seed, const Progress& progress)
{
    std::map<std::string, std::vector<ImagePair>> scenes;
    for (const ImagePair& pair : images.pairs)
        scenes[sceneOf(pair)].push_back(pair);
    std::map<std::string, std::vector<WalkPair>> walks;
    if (detected > 0)
        for (const WalkPair& pair : images.walks)
            walks[pair.scene].push_back(pair);

    cv::RNG rng(seed);
    std::vector<DescribedPair> described;
    const int all = int(scenes.size() + walks.size()) * pairsPerScene;
    int done = 0;
    const auto add = [&](const std::string& scene, Sample& sample) {
        if (rng.uniform(0, 2) == 1)
            mirror(sample);
        if (rng.uniform(0., 1.) < warps.share)
        {
            if (rng.uniform(0., 1.) < warps.sameLight)
                makeSelfPair(sample);
            warpTarget(sample.pair, warps, rng);
        }
        const bool own = detected > 0 && (sample.relief || rng.uniform(0., 1.) < detected);
        described.push_back(own ? describeDetected(scene, sample, extractor)
                                : describeFixed(scene, sample.pair, extractor));
        if (described.back().partners < FEWEST_POINTS)
            described.pop_back();
        progress(++done, all);
    };
    for (const auto& scene : scenes)
        for (int i = 0; i < pairsPerScene; i++)
        {
            Sample sample = {drawPair(scene.second, rng), cv::Ptr<Relief>()};
            add(scene.first, sample);
        }
    for (const auto& scene : walks)
        for (int i = 0; i < pairsPerScene; i++)
        {
            Sample sample = drawWalk(scene.second, rng);
            add(scene.first, sample);
        }
    return described;
}

}  // namespace iib_tools
