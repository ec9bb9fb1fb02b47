// SPDX-License-Identifier: Apache-2.0

// What a ratio test leaves of the right matches, for points detected in both images; doc/results/ratios.csv is made by it.

#include <fstream>
#include <iostream>

#include "common/command_line.hpp"
#include "common/dataset.hpp"
#include "opencv2/iib.hpp"

using namespace iib_tools;
using cv::iib::IIB;

namespace {

struct Described
{
    std::vector<cv::KeyPoint> keypoints;
    cv::Mat codes;
};

//! A name of doc/results and how to make it for AKAZE's points.
std::vector<std::pair<std::string, cv::Ptr<IIB>>> descriptors()
{
    const float factor = IIB::scaleFactorFor("AKAZE");
    std::vector<std::pair<std::string, cv::Ptr<IIB>>> all = {{"IIB", IIB::create(factor)}};
    for (const auto& preset : std::vector<std::pair<std::string, int>>{{"ACCURATE", IIB::PRESET_ACCURATE},
                 {"COMPACT", IIB::PRESET_COMPACT}, {"TINY", IIB::PRESET_TINY},
                 {"BALANCED", IIB::PRESET_BALANCED}, {"VIEWPOINT", IIB::PRESET_VIEWPOINT},
                 {"UNIVERSAL", IIB::PRESET_UNIVERSAL}, {"SMALL", IIB::PRESET_SMALL},
                 {"S512", IIB::PRESET_S512}, {"S256", IIB::PRESET_S256}, {"S128", IIB::PRESET_S128}})
        all.push_back({"IIB " + preset.first, IIB::createPreset(preset.second, factor)});
    return all;
}

//! The strongest points of an image.
std::vector<cv::KeyPoint> detect(const cv::Mat& image, int points)
{
    std::vector<cv::KeyPoint> keypoints;
    cv::AKAZE::create()->detect(image, keypoints);
    cv::KeyPointsFilter::retainBest(keypoints, points);
    return keypoints;
}

//! Counts the matches that a rule gives, and those within the tolerance of the homography.
class Rules
{
public:
    Rules(const cv::Matx33d& homography, double tolerance) : homography_(homography), tolerance_(tolerance) {}

    //! "correct,given" of mutual nearest neighbours, then of each ratio.
    std::vector<std::string> operator()(const IIB& iib, const Described& a, const Described& b) const
    {
        const cv::Ptr<cv::iib::HierarchicalMatcher> matcher =
                cv::iib::HierarchicalMatcher::create(iib.levelSizes());
        std::vector<std::string> counts;
        std::vector<cv::DMatch> matches;
        for (double ratio : ratios())
        {
            matcher->setMaxRatio(float(ratio));
            matcher->setCrossCheck(ratio == 1);
            matcher->match(a.codes, b.codes, matches);
            int correct = 0;
            for (const cv::DMatch& m : matches)
                correct += isCorrect(a.keypoints[m.queryIdx].pt, b.keypoints[m.trainIdx].pt);
            counts.push_back(cv::format("%d,%d", correct, int(matches.size())));
        }
        return counts;
    }

    //! 1: mutual nearest neighbours and no ratio test.
    static const std::vector<double>& ratios()
    {
        static const std::vector<double> all = {1, 0.7, 0.75, 0.8, 0.85, 0.9, 0.95};
        return all;
    }

private:
    bool isCorrect(const cv::Point2f& a, const cv::Point2f& b) const
    {
        const cv::Vec3d p = homography_ * cv::Vec3d(a.x, a.y, 1);
        return cv::norm(cv::Point2d(p[0] / p[2] - b.x, p[1] / p[2] - b.y)) <= tolerance_;
    }

    cv::Matx33d homography_;
    double tolerance_;
};

int run(const CommandLine& line)
{
    const std::vector<ImagePair> pairs = findPairs(line.positional());
    const auto all = descriptors();
    std::ofstream out(line.text("out"));
    out << "set,sequence,target,kind,descriptor,rule,correct,given\n";
    for (const ImagePair& pair : pairs)
    {
        if (!pair.problem.empty())
            CV_Error(cv::Error::StsBadArg, pair.name() + ": " + pair.problem);
        const LoadedPair loaded = loadPair(pair);
        const Rules rules(loaded.homography, line.number("tolerance", 0.1, 100));
        const std::vector<cv::KeyPoint> a = detect(loaded.reference, line.whole("points", 1, 1000000));
        const std::vector<cv::KeyPoint> b = detect(loaded.target, line.whole("points", 1, 1000000));
        for (const auto& descriptor : all)
        {
            Described x = {a, cv::Mat()}, y = {b, cv::Mat()};
            descriptor.second->cv::Feature2D::compute(loaded.reference, x.keypoints, x.codes);
            descriptor.second->cv::Feature2D::compute(loaded.target, y.keypoints, y.codes);
            const std::vector<std::string> counts = rules(*descriptor.second, x, y);
            for (size_t i = 0; i < counts.size(); i++)
                out << pair.set << ',' << pair.sequence << ',' << pair.target << ',' << pair.kind << ','
                    << descriptor.first << ','
                    << (i == 0 ? std::string("mutual") : cv::format("%g", Rules::ratios()[i])) << ','
                    << counts[i] << '\n';
        }
        std::cerr << pair.name() << "\n";
    }
    return out.flush() ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv)
{
    return runTool(argc, argv,
            "Right and given matches under ratio tests and under mutual matching, AKAZE's points: iib_ratios "
            "DATA...",
            "{out|ratios.csv|the CSV file}{points|1000|an image}{tolerance|3|pixels}", run);
}
