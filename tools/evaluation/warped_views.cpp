// SPDX-License-Identifier: Apache-2.0

#include <cmath>
#include <ctime>
#include <set>

#include "common/metrics.hpp"
#include "common/views.hpp"
#include "experiments.hpp"
#include "opencv2/imgcodecs.hpp"
#include "opencv2/imgproc.hpp"
#include "pose_estimates.hpp"
#include "results.hpp"

namespace iib_tools {
namespace {

const int WIDTH = 640;                // pixels of the longer side, at most
const int UNRELATED = 500;            // pairs of images of different sets
const int SLOW_EVERY = 6;             // slow methods match one photograph in so many
const double LONGITUDE = 20;          // degrees: the axis that a tilt shortens
const double GAMMA = 1.8, NOISE = 4;  // of the second image's light; grey levels

//! Makes the second image from the first: shortens an axis by the tilt, scales, then rotates.
struct Warp
{
    const char* kind;
    std::string amount;
    double scale, degrees, tilt;
    bool bySlow;  //!< whether slow methods match it
};

std::vector<Warp> warps()
{
    std::vector<Warp> all = {{"zoom and rotation", "0.5 and 45", .5, 45, 1, true},
            {"tilt and rotation", "2 and 60", 1, 60, 2, true}};
    for (double zoom : {.25, .35, .5, .66, .8, 1., 1.25, 1.5, 2.})
        all.push_back({"zoom", text(zoom), zoom, 0, 1, zoom == .25 || zoom == .5 || zoom == 1 || zoom == 2});
    for (int degrees : {10, 18, 30, 45, 60, 90, 120, 150, 180})
        all.push_back({"rotation", text(degrees), 1, double(degrees), 1, degrees % 45 == 0 && degrees != 90});
    for (double tilt : {1.5, 2., 2.5, 3., 4.})
        all.push_back({"tilt", text(tilt), 1, 0, tilt, tilt == 2 || tilt == 4});
    return all;
}

cv::Matx33d rotation(double degrees)
{
    const double c = std::cos(degrees * CV_PI / 180), s = std::sin(degrees * CV_PI / 180);
    return {c, -s, 0, s, c, 0, 0, 0, 1};
}

//! Maps pixels to a canvas that shows the whole image, or the middle of the same size if it is enlarged.
cv::Matx33d transformOf(const Warp& warp, const cv::Size& size, cv::Size& canvas)
{
    const cv::Matx33d shape = rotation(warp.degrees) * rotation(LONGITUDE) *
                              cv::Matx33d::diag({warp.scale / warp.tilt, warp.scale, 1}) *
                              rotation(-LONGITUDE);
    const double right = size.width - 1, bottom = size.height - 1;
    std::vector<cv::Point2d> at;
    cv::perspectiveTransform(
            std::vector<cv::Point2d>{{0, 0}, {right, 0}, {0, bottom}, {right, bottom}}, at, shape);
    std::vector<cv::Point2f> corners(at.begin(), at.end());
    const cv::Rect all = cv::boundingRect(corners);
    canvas = warp.scale > 1 ? size : all.size();
    const cv::Point2d shift(all.x + (all.width - canvas.width) / 2, all.y + (all.height - canvas.height) / 2);
    return cv::Matx33d(1, 0, -shift.x, 0, 1, -shift.y, 0, 0, 1) * shape;
}

//! Warps, darkens and adds noise. Supersamples, since a sensor averages over the area of a pixel.
cv::Mat warped(const cv::Mat& image, const Warp& warp, uint64 seed, cv::Matx33d& truth)
{
    cv::Size canvas;
    truth = transformOf(warp, image.size(), canvas);
    const int finer = std::max(2, cvCeil(2 * warp.tilt / warp.scale));
    const double shift = (finer - 1) / 2.;
    cv::Mat fine, result;
    cv::warpPerspective(image, fine, cv::Matx33d(finer, 0, shift, 0, finer, shift, 0, 0, 1) * truth,
            canvas * finer, cv::INTER_LINEAR, cv::BORDER_CONSTANT, cv::Scalar(128));
    cv::resize(fine, result, canvas, 0, 0, cv::INTER_AREA);
    result.convertTo(result, CV_32F, 1 / 255.);
    cv::pow(result, GAMMA, result);
    cv::Mat noise(canvas, CV_32F);
    cv::RNG(seed).fill(noise, cv::RNG::NORMAL, 0, NOISE);
    cv::Mat(result * 255 + noise).convertTo(result, CV_8U);
    return result;
}

cv::Mat readReduced(const std::string& file)
{
    cv::Mat image = readImage(file);
    const double scale = double(WIDTH) / std::max(image.cols, image.rows);
    if (scale < 1)
        cv::resize(image, image, cv::Size(), scale, scale, cv::INTER_AREA);
    return image;
}

//! Processor time of this thread, milliseconds; a task uses no other thread.
double processorTime()
{
    timespec time;
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
    return double(time.tv_sec) * 1e3 + double(time.tv_nsec) * 1e-6;
}

void matchBy(const PairMethod& method, const LoadedPair& images, double tolerance, const Fields& key,
        ResultTable& table)
{
    Points points;
    const double start = processorTime();
    const bool found = method.match(images.reference, images.target, points);
    const double time = processorTime() - start;
    int right = 0;
    for (size_t i = 0; i < points.target.size(); i++)
        right += projectionError(images.homography, points.reference[i], points.target[i]) < tolerance;
    table.append(with(key, method.name, int(found), right, points.target.size(), time));
}

//! One photograph of each sequence and of each folder of views: set, sequence, file.
std::vector<Fields> photographs(const Options& options, const std::vector<ImagePair>& pairs)
{
    std::vector<Fields> all;
    for (const ImagePair& pair : pairs)
        if (all.empty() || all.back()[2] != pair.referenceFile)
            all.push_back({pair.set, pair.sequence, pair.referenceFile});
    for (const auto& folders : findViewFolders(options.roots))
        for (const ViewFolder& folder : folders.second)
            if (!folder.views.empty())
                all.push_back({baseName(folders.first), folder.name, folder.views[0].file});
    return all;
}

}  // namespace

int warpedViews(const Options& options, const std::vector<ImagePair>& pairs)
{
    Experiment experiment(options.out, "views",
            {"set", "sequence", "kind", "amount", "method", "found", "right", "matches", "milliseconds"}, 5);
    const auto plan = [&](const Fields& key, const std::function<bool(const PairMethod&)>& isUsed,
                              const std::function<LoadedPair()>& load) {
        std::vector<PairMethod> missing;
        for (const PairMethod& method : pairMethods(options.points))
            if (isUsed(method) && !experiment.table.has(with(key, method.name)))
                missing.push_back(method);
        const auto run = [&, key, load, missing] {
            const LoadedPair images = load();
            for (const PairMethod& method : missing)
                matchBy(method, images, options.tolerance, key, experiment.table);
        };
        if (!missing.empty())
            experiment.plan({}, key[0] + "/" + key[1] + " " + key[2] + " " + key[3], run);
    };
    const std::vector<Fields> all = photographs(options, pairs);
    for (size_t i = 0; i < all.size(); i++)
        for (const Warp& warp : warps())
            plan(
                    {all[i][0], all[i][1], warp.kind, warp.amount},
                    [&](const PairMethod& method) {
                        return !method.slow || (warp.bySlow && i % SLOW_EVERY == 0);
                    },
                    [&all, warp, i] {
                        LoadedPair images;
                        images.reference = readReduced(all[i][2]);
                        images.target = warped(images.reference, warp, i + 1, images.homography);
                        return images;
                    });
    cv::RNG random(1);
    std::set<std::pair<const ImagePair*, const ImagePair*>> drawn;
    for (int k = 0; drawn.size() < UNRELATED && k < 10 * UNRELATED && !pairs.empty(); k++)
    {
        const ImagePair &one = pairs[random.uniform(0, (int)pairs.size())],
                        &other = pairs[random.uniform(0, (int)pairs.size())];
        if (one.set != other.set && drawn.insert({&one, &other}).second)
            plan(
                    {one.set, one.sequence + "/" + one.target + " and " + other.name(), "unrelated", ""},
                    [](const PairMethod& m) { return m.name == "matchViews" || m.name == "SIFT"; },
                    [&one, &other] {  // no match is right
                        return LoadedPair{readReduced(one.referenceFile), readReduced(other.targetFile),
                                cv::Matx33d::zeros(), {}, {}};
                    });
    }
    return experiment.run();
}

}  // namespace iib_tools
