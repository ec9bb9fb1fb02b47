// SPDX-License-Identifier: Apache-2.0

#include "common/views.hpp"
#include "experiments.hpp"
#include "opencv2/core/affine.hpp"
#include "opencv2/iib.hpp"
#include "opencv2/iib/alignment.hpp"
#include "opencv2/iib/relative_pose.hpp"
#include "opencv2/imgcodecs.hpp"
#include "opencv2/imgproc.hpp"
#include "results.hpp"
#include "uncertainty.hpp"

namespace iib_tools {
namespace {

using cv::iib::HierarchicalMatcher;
using cv::iib::IIBDescriptorExtractor;

const double MOST_MOVED = .06;  // of a corner, as a share of the image's size
const size_t STRANGERS = 3;     // views of other places for each pair
const int BORDER = 20;          // pixels along a rectified image's border without keypoints
const double FAR = 3;           // pixels from the truth: a wrong match, which no deviation describes

struct Matched
{
    std::vector<cv::KeyPoint> first, second;
    std::vector<cv::DMatch> matches;
};

Matched matched(const cv::Mat& first, const cv::Mat& second, int points, const cv::Mat& mask1 = cv::Mat(),
        const cv::Mat& mask2 = cv::Mat())
{
    const cv::Ptr<IIBDescriptorExtractor> extractor = IIBDescriptorExtractor::createRecommended(points);
    Matched m;
    cv::Mat codes1, codes2;
    extractor->detectAndCompute(first, mask1, m.first, codes1);
    extractor->detectAndCompute(second, mask2, m.second, codes2);
    HierarchicalMatcher::createRecommended()->match(codes1, codes2, m.matches);
    return m;
}

//! A pair as one camera sees it, with masks.
struct Stereo
{
    ViewPair pair;
    cv::Mat first, second, mask1, mask2;
};

//! Both views as one camera would see them, rotated to look across the baseline.
Stereo rectified(const Stereo& stereo)
{
    Stereo turned = {stereo.pair, {}, {}, {}, {}};
    const cv::Matx33d& camera = stereo.pair.referenceCamera;
    const Rectification turns = rectificationOf(stereo.pair.rotation, stereo.pair.translation);
    const cv::Size size = stereo.first.size();
    const auto see = [&](const cv::Mat& image, const cv::Matx33d& seen, cv::Mat& result, cv::Mat& mask) {
        cv::warpPerspective(image, result, seen, size, cv::INTER_CUBIC);
        cv::warpPerspective(cv::Mat(image.size(), CV_8U, cv::Scalar(255)), mask, seen, size);
        cv::erode(mask, mask, cv::Mat(), cv::Point(-1, -1), BORDER, cv::BORDER_CONSTANT, cv::Scalar(0));
    };
    see(stereo.first, camera * turns.first * camera.inv(), turned.first, turned.mask1);
    see(stereo.second, camera * turns.second * stereo.pair.targetCamera.inv(), turned.second, turned.mask2);
    turned.pair.set += " rectified";
    turned.pair.targetCamera = camera;
    turned.pair.rotation = cv::Matx33d::eye();
    turned.pair.translation = turns.t;
    return turned;
}

cv::Matx33d fundamentalOf(const ViewPair& pair)
{
    const cv::Vec3d t = pair.translation;
    const cv::Matx33d cross(0, -t[2], t[1], t[2], 0, -t[0], -t[1], t[0], 0);
    return pair.targetCamera.inv().t() * cross * pair.rotation * pair.referenceCamera.inv();
}

//! Errors of refined points of the second image across the true epipolar lines; wrong matches are left out.
std::vector<JudgedError> acrossLines(const cv::Matx33d& fundamental, const cv::Mat& points1,
        const cv::Mat& points2, const cv::Mat& covariances, const cv::Mat& similarities)
{
    std::vector<JudgedError> errors;
    for (int i = 0; i < points1.rows; i++)
    {
        const cv::Vec2f a = points1.at<cv::Vec2f>(i), b = points2.at<cv::Vec2f>(i);
        const cv::Vec3f c = covariances.at<cv::Vec3f>(i);
        const cv::Vec3d line = fundamental * cv::Vec3d(a[0], a[1], 1);
        const cv::Vec2d normal = cv::normalize(cv::Vec2d(line[0], line[1]));
        const double error =
                (line[0] * b[0] + line[1] * b[1] + line[2]) / cv::norm(cv::Vec2d(line[0], line[1]));
        const cv::Vec2d along = cv::Matx22d(c[0], c[1], c[1], c[2]) * normal;
        if (similarities.at<float>(i) >= 0 && std::abs(error) < FAR)
            errors.push_back(judged(cv::Vec<double, 1>(error), cv::Matx<double, 1, 1>(normal.dot(along))));
    }
    return errors;
}

void judgePose(const Stereo& stereo, int points, const ErrorRows& rows)
{
    const ViewPair& pair = stereo.pair;
    Matched m = matched(stereo.first, stereo.second, points, stereo.mask1, stereo.mask2);
    cv::Mat points1, points2, covariances, similarities, R, t, covariance;
    cv::iib::propagateMatches(stereo.first, m.first, stereo.second, m.second, m.matches, points1, points2,
            covariances, similarities);
    rows.add("propagated points across epipolar lines",
            acrossLines(fundamentalOf(pair), points1, points2, covariances, similarities), 1);
    std::vector<JudgedError> rotation, direction;
    if (cv::iib::findRelativePose(points1, points2, pair.referenceCamera, pair.targetCamera, R, t,
                cv::noArray(), 0, covariance))
    {
        const cv::Matx33d turnedBack = cv::Matx33d(R).t();
        const cv::Vec3d found(t), truth = cv::normalize(pair.translation);
        const cv::Matx<double, 5, 5> all(covariance);
        rotation.push_back(
                judged(cv::Affine3d(pair.rotation * turnedBack).rvec(), all.get_minor<3, 3>(0, 0)));
        direction.push_back(judged(alongTangents(found, truth), all.get_minor<2, 2>(3, 3)));
    }
    rows.add("rotation of findRelativePose", rotation, 3);
    rows.add("direction of findRelativePose", direction, 2);
}

//! The kind of a rendered place, without the number of the instance: rooms share furniture, and facades windows.
std::string kindOf(const ViewPair& pair) { return pair.set.substr(0, pair.set.find_last_of('_')); }

//! Searches a pose between images of different places, where none exists.
void judgeStrangers(const ViewPair& pair, const ViewPair& other, int points, const ErrorRows& rows)
{
    const cv::Mat first = readImage(pair.referenceFile), second = readImage(other.targetFile);
    Matched m = matched(first, second, points);
    cv::Mat points1, points2, R, t;
    cv::iib::propagateMatches(first, m.first, second, m.second, m.matches, points1, points2);
    const bool found =
            cv::iib::findRelativePose(points1, points2, pair.referenceCamera, other.targetCamera, R, t);
    rows.add("pose of findRelativePose",
            std::vector<JudgedError>(found ? 1 : 0, {std::numeric_limits<double>::infinity(), 0, 0}), 2);
}

void judgePoints(const ImagePair& pair, int points, const ErrorRows& rows)
{
    const LoadedPair loaded = loadPair(pair);
    const Matched m = matched(loaded.reference, loaded.target, points);
    cv::Mat points1, points2, covariances, similarities;
    cv::iib::refineMatches(loaded.reference, m.first, loaded.target, m.second, m.matches, points1, points2,
            covariances, similarities);
    std::vector<JudgedError> errors;
    for (int i = 0; i < points1.rows; i++)
    {
        const cv::Vec2f a = points1.at<cv::Vec2f>(i), b = points2.at<cv::Vec2f>(i);
        const cv::Vec3f c = covariances.at<cv::Vec3f>(i);
        const cv::Vec3d there = loaded.homography * cv::Vec3d(a[0], a[1], 1);
        const cv::Vec2d error(b[0] - there[0] / there[2], b[1] - there[1] / there[2]);
        if (similarities.at<float>(i) >= 0 && cv::norm(error) < FAR)
            errors.push_back(judged(error, cv::Matx22d(c[0], c[1], c[1], c[2])));
    }
    rows.add("points of refineMatches", errors, 2);
}

void judgeAlignment(const ImagePair& pair, uint64 seed, const ErrorRows& rows)
{
    const LoadedPair loaded = loadPair(pair);
    cv::RNG random(seed);
    const cv::Size size = loaded.target.size();
    const float right = float(size.width - 1), bottom = float(size.height - 1);
    const std::vector<cv::Point2f> from = {{0, 0}, {right, 0}, {right, bottom}, {0, bottom}};
    std::vector<cv::Point2f> to = from, places, trueOnes;
    for (cv::Point2f& corner : to)
    {
        corner.y += float(random.uniform(-MOST_MOVED, MOST_MOVED) * size.height);
        corner.x += float(random.uniform(-MOST_MOVED, MOST_MOVED) * size.width);
    }
    const cv::Matx33d moved = cv::getPerspectiveTransform(from, to);
    cv::Mat image, transform, error;
    cv::warpPerspective(loaded.target, image, moved, size, cv::INTER_CUBIC, cv::BORDER_REFLECT);
    std::vector<JudgedError> errors;
    if (cv::iib::alignImages(loaded.reference, image, transform, cv::iib::ALIGN_HOMOGRAPHY, error))
    {
        cv::perspectiveTransform(from, places, transform);
        cv::perspectiveTransform(from, trueOnes, (moved * loaded.homography).inv());
        for (int k = 0; k < 4; k++)  // reported is the deviation of a length, of two coordinates
            errors.push_back(judged(cv::Vec2d(cv::Point2d(places[k] - trueOnes[k])),
                    cv::Matx22d::eye() * (error.at<double>(k) * error.at<double>(k) / 2)));
    }
    rows.add("corners of alignImages", errors, 2);
}

}  // namespace

int uncertainty(const Options& options, const std::vector<ImagePair>& pairs)
{
    Experiment experiment(options.out, "uncertainty", ErrorRows::columns({"set", "sequence", "target"}), 4);
    const std::vector<ViewPair> views = findViewPairs(options.roots);
    cv::RNG random(1);
    for (size_t i = 0; i < STRANGERS * views.size(); i++)
    {
        const ViewPair &pair = views[i % views.size()],
                       &other = views[size_t(random.uniform(0, int(views.size())))];
        const Fields key = {"strangers", pair.set + " " + std::to_string(i), other.set + " " + other.target};
        if (kindOf(pair) != kindOf(other))
            experiment.plan(with(key, "pose of findRelativePose"), key[1] + " and " + key[2], [&, key] {
                judgeStrangers(pair, other, options.points, ErrorRows(experiment.table, key));
            });
    }
    for (const ViewPair& pair : views)
        experiment.plan(with(pair.key(), "direction of findRelativePose"), pair.name(), [&] {
            const auto judge = [&](const Stereo& stereo) {
                judgePose(stereo, options.points, ErrorRows(experiment.table, stereo.pair.key()));
            };
            const Stereo stereo = {pair, readImage(pair.referenceFile), readImage(pair.targetFile), {}, {}};
            if (pair.sameLight)
                judge(rectified(stereo));
            judge(stereo);
        });
    for (size_t i = 0; i < pairs.size(); i++)
        if (pairs[i].kind == "light")
            experiment.plan(with(pairs[i].key(), "corners of alignImages"), pairs[i].name(), [&, i] {
                const ErrorRows rows(experiment.table, pairs[i].key());
                judgePoints(pairs[i], options.points, rows);
                judgeAlignment(pairs[i], i + 1, rows);
            });
    return experiment.run();
}

}  // namespace iib_tools
