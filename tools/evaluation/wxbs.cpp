// SPDX-License-Identifier: Apache-2.0

#include <fstream>
#include <sstream>

#include "experiments.hpp"
#include "opencv2/calib3d.hpp"
#include "opencv2/core/utils/filesystem.hpp"
#include "pose_estimates.hpp"
#include "results.hpp"

namespace iib_tools {
namespace {

const int THRESHOLDS = 20;  // 0 to 19 pixels, as in wxbs_benchmark

Points readCorrespondences(const std::string& file)
{
    std::ifstream in(file);
    Points points;
    for (std::string line; std::getline(in, line);)
    {
        std::istringstream words(line);
        cv::Point2d one, two;
        if (words >> one.x && !(words >> one.y >> two.x >> two.y))
            CV_Error(cv::Error::StsParseError, file + ": not four numbers a line");
        if (words)
        {
            points.reference.push_back(one);
            points.target.push_back(two);
        }
    }
    if (points.target.empty())
        CV_Error(cv::Error::StsParseError, file + ": no correspondences");
    return points;
}

//! The fundamental matrix, with the settings of WxBS's own example; empty for fewer than eight matches.
cv::Mat fundamental(const Points& points)
{
    return points.target.size() < 8 ? cv::Mat()
                                    : cv::findFundamentalMat(points.reference, points.target, cv::USAC_MAGSAC,
                                              .25, .999, 100000);
}

//! Distances of both points from their epipolar lines, pixels: the root of the sum of their squares.
double epipolarError(const cv::Matx33d& F, const cv::Point2d& one, const cv::Point2d& two)
{
    const cv::Vec3d first(one.x, one.y, 1), second(two.x, two.y, 1), line2 = F * first,
                                                                     line1 = F.t() * second;
    return std::abs(second.dot(line2)) * std::sqrt(1 / (line1[0] * line1[0] + line1[1] * line1[1]) +
                                                   1 / (line2[0] * line2[0] + line2[1] * line2[1]));
}

void matchMarked(const PairMethod& method, int points, const ImagePair& pair, ResultTable& table)
{
    const Points truth = readCorrespondences(
            cv::utils::fs::join(cv::utils::fs::getParent(pair.referenceFile), "corrs.txt"));
    const LoadedPair images = loadPair(pair);
    Points matches;
    const bool found = method.match(images.reference, images.target, matches);
    const cv::Mat F = fundamental(matches);
    double share = 0, within10 = 0;
    for (size_t i = 0; F.rows == 3 && i < truth.target.size(); i++)
    {
        const double error = epipolarError(F, truth.reference[i], truth.target[i]);
        for (int threshold = 0; threshold < THRESHOLDS; threshold++)
            share += error <= threshold;
        within10 += error <= 10;
    }
    const double count = double(truth.target.size());
    table.append(with({pair.set, pair.sequence, method.name}, points, int(found), matches.target.size(),
            within10 / count, share / count / THRESHOLDS));
}

}  // namespace

int wxbs(const Options& options, const std::vector<ImagePair>& pairs)
{
    if (pairs.empty())
        return 0;
    Experiment experiment(options.out, "wxbs",
            {"set", "sequence", "method", "points", "found", "matches", "within_10", "share"}, 3);
    const std::vector<PairMethod> methods = pairMethods(options.points);
    for (const ImagePair& pair : pairs)
        for (const PairMethod& method : methods)
            if (!method.slow)
                experiment.plan({pair.set, pair.sequence, method.name}, pair.name() + ", " + method.name,
                        [&] { matchMarked(method, options.points, pair, experiment.table); });
    return experiment.run();
}

}  // namespace iib_tools
