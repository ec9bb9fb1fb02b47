// SPDX-License-Identifier: Apache-2.0

#include <set>

#include "experiments.hpp"
#include "opencv2/imgproc.hpp"
#include "seeded.hpp"

namespace iib_tools {
namespace {

//! A change of the view made from the reference itself, about its centre.
struct Warp
{
    std::string kind;
    double amount;  //!< degrees, or factor
};

std::vector<Warp> warps()
{
    std::vector<Warp> all;
    for (int degrees : {5, 10, 15, 30, 45, 90, 135, 180})
        all.push_back({"turn", double(degrees)});
    for (double factor : {0.5, 0.7, 0.85, 1.2, 1.4, 2.0})
        all.push_back({"scale", factor});
    return all;
}

LoadedPair warpedPair(const cv::Mat& reference, const Warp& warp)
{
    const cv::Point2f centre(float(reference.cols - 1) / 2, float(reference.rows - 1) / 2);
    const bool turn = warp.kind == "turn";
    const cv::Mat affine = cv::getRotationMatrix2D(centre, turn ? warp.amount : 0, turn ? 1 : warp.amount);
    LoadedPair pair;
    pair.reference = reference;
    // Smaller images are averaged, larger ones interpolated, as a camera's lens and sensor would do.
    cv::Mat source = reference;
    if (!turn && warp.amount < 1)
        cv::GaussianBlur(reference, source, cv::Size(), 0.5 / warp.amount);
    cv::warpAffine(source, pair.target, affine, reference.size(), cv::INTER_CUBIC, cv::BORDER_REFLECT_101);
    pair.homography = cv::Matx33d::eye();
    for (int y = 0; y < 2; y++)
        for (int x = 0; x < 3; x++)
            pair.homography(y, x) = affine.at<double>(y, x);
    return pair;
}

}  // namespace

int robustness(const Options& options, const std::vector<ImagePair>& pairs)
{
    ResultTable table(options.out + "/robustness.csv", seededColumns(), 5);
    std::vector<Task> tasks;
    std::set<std::string> turned;  // one sequence a set
    for (const ImagePair& pair : pairs)
    {
        if (!turned.insert(pair.set).second)
            continue;
        for (const Warp& warp : warps())
            addSeededTask(
                    options, {pair.set, pair.sequence, text(warp.amount), warp.kind},
                    robustnessConfigurations(),
                    [pair, warp] { return warpedPair(loadPair(pair).reference, warp); }, table, tasks);
    }
    return runTasks("robustness", tasks, &table);
}

}  // namespace iib_tools
