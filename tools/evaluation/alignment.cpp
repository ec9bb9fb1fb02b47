// SPDX-License-Identifier: Apache-2.0
#include "opencv2/iib/alignment.hpp"

#include <set>

#include "experiments.hpp"
#include "opencv2/imgproc.hpp"
#include "results.hpp"

namespace iib_tools {
namespace {

const int OTHER_SCENES = 520;    // pairs of images of different sets
const int WITH_LOGO = 36;        // of these pairs, those that also get a common part
const int LOGO = 100;            // side of the common part, pixels
const double MOST_MOVED = 0.06;  // of a corner, as a share of the image's size
const double NOISE = 8;          // grey levels
const cv::Point SHIFT(17, -9);   // pixels between noisy images
const char* const MODELS[] = {"TRANSLATION", "SIMILARITY", "AFFINE", "HOMOGRAPHY"};

std::vector<cv::Point2d> corners(const cv::Size& size)
{
    const double right = size.width - 1, bottom = size.height - 1;
    return {{0, 0}, {right, 0}, {right, bottom}, {0, bottom}};
}

bool stoodStill(const ImagePair& pair)
{
    return pair.homographyFile.empty() ||
           cv::norm(readHomography(pair.homographyFile), cv::Matx33d::eye(), cv::NORM_INF) == 0;
}

//! A random transform of a model that moves corners by MOST_MOVED at most.
cv::Matx33d randomTransform(cv::RNG& random, const cv::Size& size, int model)
{
    std::vector<cv::Point2f> from, to;
    for (const cv::Point2d& corner : corners(size))
    {
        const double x = random.uniform(-MOST_MOVED, MOST_MOVED), y = random.uniform(-MOST_MOVED, MOST_MOVED);
        from.push_back(corner);
        to.push_back(corner + cv::Point2d(x * size.width, y * size.height));
    }
    if (model == cv::iib::ALIGN_HOMOGRAPHY)
        return cv::getPerspectiveTransform(from, to);
    cv::Matx23d affine(1, 0, to[0].x, 0, 1, to[0].y);
    if (model == cv::iib::ALIGN_AFFINE)
        affine = cv::getAffineTransform(from.data(), to.data());
    else if (model == cv::iib::ALIGN_SIMILARITY)  // by two corners
    {
        const cv::Point2f before = from[2] - from[0], after = to[2] - to[0];
        const double length2 = before.ddot(before), c = before.ddot(after) / length2,
                     s = before.cross(after) / length2;
        affine = cv::Matx23d(c, -s, to[0].x, s, c, to[0].y);
    }
    cv::Matx33d all = cv::Matx33d::eye();
    for (int k = 0; k < 6; k++)
        all.val[k] = affine.val[k];
    return all;
}

//! Mean error of the image's corners in the reference, pixels, and mean of (error / estimated deviation)^2.
Fields errorsOf(
        const cv::Mat& found, const cv::Mat& deviations, const cv::Matx33d& truth, const cv::Size& size)
{
    std::vector<cv::Point2d> places, trueOnes;
    cv::perspectiveTransform(corners(size), places, found);
    cv::perspectiveTransform(corners(size), trueOnes, truth);
    double sum = 0, squares = 0;
    for (int k = 0; k < 4; k++)
    {
        const double error = cv::norm(places[k] - trueOnes[k]);
        sum += error;
        squares += std::pow(error / deviations.at<double>(k), 2);
    }
    return {text(sum / 4), text(squares / 4)};
}

//! Appends a row for each model. @param truth null if the images show different scenes
void alignAll(const cv::Mat& reference, const cv::Mat& image, const Fields& key, const cv::Matx33d* truth,
        ResultTable& table)
{
    for (int model = cv::iib::ALIGN_TRANSLATION; model <= cv::iib::ALIGN_HOMOGRAPHY; model++)
    {
        cv::Mat transform, deviations, matches;
        const int found = cv::iib::alignImages(reference, image, transform, model, deviations, matches);
        const Fields errors = found && truth ? errorsOf(transform, deviations, *truth, image.size())
                                             : Fields{truth ? "inf" : "", ""};
        table.append(with(key, MODELS[model], found, matches.rows, errors[0], errors[1]));
    }
}

std::string movedBy(int model) { return std::string("moved by a ") + MODELS[model]; }

//! Aligns a pair whose second image was moved by a transform.
void alignMoved(const ImagePair& pair, int by, uint64 seed, ResultTable& table)
{
    const LoadedPair loaded = loadPair(pair);
    cv::RNG random(seed);
    const cv::Matx33d moved = randomTransform(random, loaded.target.size(), by);
    cv::Mat image;
    cv::warpPerspective(
            loaded.target, image, moved, loaded.target.size(), cv::INTER_CUBIC, cv::BORDER_REFLECT);
    const cv::Matx33d truth = (moved * loaded.homography).inv();
    alignAll(loaded.reference, image, with(pair.key(), movedBy(by)), &truth, table);
}

//! Aligns two parts of one image, SHIFT apart, each with its own noise.
void alignNoisy(const ImagePair& pair, uint64 seed, ResultTable& table)
{
    const cv::Mat whole = loadPair(pair).reference;
    const cv::Point margin(std::abs(SHIFT.x), std::abs(SHIFT.y));
    const cv::Rect part(margin, cv::Size(whole.size() - cv::Size(2 * margin)));
    cv::RNG random(seed);
    cv::Mat images[2];
    for (int i = 0; i < 2; i++)
    {
        cv::Mat noise(part.size(), CV_16S);
        random.fill(noise, cv::RNG::NORMAL, 0, NOISE);
        cv::add(whole(i ? part + SHIFT : part), noise, images[i], cv::noArray(), CV_8U);
    }
    const cv::Matx33d truth(1, 0, SHIFT.x, 0, 1, SHIFT.y, 0, 0, 1);
    alignAll(images[0], images[1], with(pair.key(), "with noise"), &truth, table);
}

void alignOthers(const ImagePair& pair, const ImagePair& other, ResultTable& table)
{
    alignAll(
            loadPair(pair).reference, loadPair(other).target, with(pair.key(), other.name()), nullptr, table);
}

//! Aligns images of different scenes with a part of a third image in both upper left corners.
void alignLogos(const ImagePair& pair, const ImagePair& other, const ImagePair& logo, ResultTable& table)
{
    cv::Mat images[] = {loadPair(pair).reference, loadPair(other).target};
    const cv::Mat third = loadPair(logo).reference;
    const cv::Rect middle((third.cols - LOGO) / 2, (third.rows - LOGO) / 2, LOGO, LOGO);
    for (cv::Mat& image : images)
        third(middle).copyTo(image(cv::Rect(20, 20, LOGO, LOGO)));
    alignAll(images[0], images[1], with(pair.key(), "logo " + other.name()), nullptr, table);
}

}  // namespace

int alignment(const Options& options, const std::vector<ImagePair>& all)
{
    std::vector<ImagePair> pairs;
    for (const ImagePair& pair : all)
        if (pair.kind == "light")
            pairs.push_back(pair);
    Experiment experiment(options.out, "alignment",
            {"set", "sequence", "target", "image", "model", "found", "matches", "error", "squares"}, 5);
    ResultTable& table = experiment.table;
    const auto plan = [&](const ImagePair& pair, const std::string& image, const std::function<void()>& run) {
        experiment.plan(with(pair.key(), image, MODELS[cv::iib::ALIGN_HOMOGRAPHY]),
                pair.name() + " and " + image, run);
    };
    for (size_t i = 0; i < pairs.size(); i++)
    {
        for (int by = cv::iib::ALIGN_TRANSLATION; by <= cv::iib::ALIGN_HOMOGRAPHY; by++)
            if (by == cv::iib::ALIGN_HOMOGRAPHY || stoodStill(pairs[i]))
                plan(pairs[i], movedBy(by), [&, i, by] { alignMoved(pairs[i], by, i + 1, table); });
        plan(pairs[i], "with noise", [&, i] { alignNoisy(pairs[i], i + 1, table); });
    }
    cv::RNG random(1);
    std::set<std::pair<const ImagePair*, std::string>> others;
    for (int drawn = 0; others.size() < OTHER_SCENES && drawn < 10 * OTHER_SCENES && !pairs.empty(); drawn++)
    {
        const ImagePair &pair = pairs[random.uniform(0, (int)pairs.size())],
                        &other = pairs[random.uniform(0, (int)pairs.size())];
        // Two sequences of a set may be of one camera.
        if (pair.set == other.set || !others.insert({&pair, other.name()}).second)
            continue;
        plan(pair, other.name(), [&pair, &other, &table] { alignOthers(pair, other, table); });
        const ImagePair& third = pairs[drawn % pairs.size()];
        if (others.size() <= WITH_LOGO)
            plan(pair, "logo " + other.name(), [&] { alignLogos(pair, other, third, table); });
    }
    return experiment.run();
}

}  // namespace iib_tools
