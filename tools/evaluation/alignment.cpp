// SPDX-License-Identifier: Apache-2.0
#include "opencv2/iib/alignment.hpp"

#include <set>

#include "experiments.hpp"
#include "opencv2/imgproc.hpp"
#include "results.hpp"

namespace iib_tools {
namespace {

const int OTHER_SCENES = 520;    // pairs of images of different sets, in all
const double MOST_MOVED = 0.06;  // of a corner, in parts of the image's size

std::vector<cv::Point2d> corners(const cv::Size& size)
{
    const double right = size.width - 1, bottom = size.height - 1;
    return {{0, 0}, {right, 0}, {right, bottom}, {0, bottom}};
}

cv::Matx33d randomHomography(cv::RNG& random, const cv::Size& size)
{
    std::vector<cv::Point2f> from, to;
    for (const cv::Point2d& corner : corners(size))
    {
        from.push_back(corner);
        to.push_back(corner + cv::Point2d(random.uniform(-MOST_MOVED, MOST_MOVED) * size.width,
                                      random.uniform(-MOST_MOVED, MOST_MOVED) * size.height));
    }
    return cv::getPerspectiveTransform(from, to);
}

//! How far the corners of the image lie from their true places in the reference on average, in pixels.
double cornerError(const cv::Mat& found, const cv::Matx33d& truth, const cv::Size& size)
{
    std::vector<cv::Point2d> places, trueOnes;
    cv::perspectiveTransform(corners(size), places, found);
    cv::perspectiveTransform(corners(size), trueOnes, truth);
    double sum = 0;
    for (int k = 0; k < 4; k++)
        sum += cv::norm(places[k] - trueOnes[k]);
    return sum / 4;
}

void alignPair(const ImagePair& pair, uint64 seed, ResultTable& table)
{
    const LoadedPair loaded = loadPair(pair);
    cv::RNG random(seed);
    const cv::Matx33d moved = randomHomography(random, loaded.target.size());
    cv::Mat image, transform, matches;
    cv::warpPerspective(
            loaded.target, image, moved, loaded.target.size(), cv::INTER_CUBIC, cv::BORDER_REFLECT);
    const bool found = cv::iib::alignImages(
            loaded.reference, image, transform, cv::iib::ALIGN_HOMOGRAPHY, cv::noArray(), matches);
    const cv::Matx33d truth = (moved * loaded.homography).inv();
    table.append({pair.set, pair.sequence, pair.target, "same scene", std::to_string(found),
            std::to_string(matches.rows),
            found ? text(cornerError(transform, truth, image.size())) : std::string("inf")});
}

void alignOthers(const ImagePair& pair, const ImagePair& other, ResultTable& table)
{
    cv::Mat transform, matches;
    const bool found = cv::iib::alignImages(loadPair(pair).reference, loadPair(other).target, transform,
            cv::iib::ALIGN_HOMOGRAPHY, cv::noArray(), matches);
    table.append({pair.set, pair.sequence, pair.target, other.name(), std::to_string(found),
            std::to_string(matches.rows), ""});
}

}  // namespace

int alignment(const Options& options, const std::vector<ImagePair>& all)
{
    std::vector<ImagePair> pairs;
    for (const ImagePair& pair : all)
        if (pair.kind == "light")
            pairs.push_back(pair);
    ResultTable table(options.out + "/alignment.csv",
            {"set", "sequence", "target", "image", "found", "matches", "error"}, 4);
    std::vector<Task> tasks;
    for (size_t i = 0; i < pairs.size(); i++)
        if (!table.has({pairs[i].set, pairs[i].sequence, pairs[i].target, "same scene"}))
            tasks.push_back({pairs[i].name(), [&, i] { alignPair(pairs[i], i + 1, table); }});
    cv::RNG random(1);
    std::set<std::pair<const ImagePair*, std::string>> others;
    for (int drawn = 0; others.size() < OTHER_SCENES && drawn < 10 * OTHER_SCENES && !pairs.empty(); drawn++)
    {
        const ImagePair &pair = pairs[random.uniform(0, (int)pairs.size())],
                        &other = pairs[random.uniform(0, (int)pairs.size())];
        // Two sequences of a set may be of one camera.
        if (pair.set == other.set || !others.insert({&pair, other.name()}).second)
            continue;
        if (!table.has({pair.set, pair.sequence, pair.target, other.name()}))
            tasks.push_back({pair.name() + " and " + other.name(),
                    [&pair, &other, &table] { alignOthers(pair, other, table); }});
    }
    return runTasks("alignment", tasks, &table);
}

}  // namespace iib_tools
