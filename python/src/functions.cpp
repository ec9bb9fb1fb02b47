// SPDX-License-Identifier: Apache-2.0

#include "bindings.hpp"
#include "held.hpp"

#include "../../modules/iib_geometry/src/verdict/verdict.hpp"
#include "../../modules/iib_geometry/src/views/view.hpp"
#include "opencv2/iib.hpp"
#include "opencv2/iib/detail/prepared_image.hpp"
#include "opencv2/iib_geometry.hpp"

namespace iib_python {

namespace {

using cv::iib::PreparedImage;
typedef std::vector<cv::KeyPoint> KeyPoints;
typedef std::vector<cv::DMatch> Matches;

// Rotation, both images' keypoints, and matches.
std::tuple<double, KeyPoints, KeyPoints, Matches> matchRotated(const cv::Mat& image1, KeyPoints first,
        const cv::Mat& image2, KeyPoints second, const HeldDetector<cv::iib::IIB>& extractor,
        const Held<cv::iib::HierarchicalMatcher>& matcher, double rotation)
{
    Matches matches;
    rotation = cv::iib::matchRotated(image1, first, image2, second, extractor.held.staticCast<cv::iib::IIB>(),
            matcher.held, matches, rotation);
    return {rotation, first, second, matches};
}

std::tuple<cv::Mat, cv::Mat, cv::Mat, cv::Mat> refineMatches(const cv::Mat& image1, const KeyPoints& first,
        const cv::Mat& image2, const KeyPoints& second, const Matches& matches)
{
    cv::Mat points1, points2, covariances, similarities;
    cv::iib::refineMatches(
            image1, first, image2, second, matches, points1, points2, covariances, similarities);
    return {points1, points2, covariances, similarities};
}

// Image: a matrix or a PreparedImage.
template <typename Image>
std::tuple<Matches, cv::Mat, cv::Mat, cv::Mat, cv::Mat> propagateMatches(const Image& image1,
        const KeyPoints& first, const Image& image2, const KeyPoints& second, Matches matches)
{
    cv::Mat points1, points2, covariances, similarities;
    cv::iib::propagateMatches(
            image1, first, image2, second, matches, points1, points2, covariances, similarities);
    for (cv::DMatch& match : matches)
        match.distance = 0;  // not a whole number; the caller knows them
    return {matches, points1, points2, covariances, similarities};
}

std::optional<cv::Mat> onlyIf(bool found, const cv::Mat& matrix)
{
    return found ? std::optional<cv::Mat>(matrix) : std::nullopt;
}

// Whether there is a pose, R, t, marks of the inliers, covariance; and why there is none.
auto findRelativePose(const cv::Mat& points1, const cv::Mat& points2, const cv::Mat& camera1,
        const cv::Mat& camera2, double scale, const cv::Mat& covariances)
{
    cv::Mat R, t, inliers, covariance;
    cv::String reason;
    const bool found = cv::iib::findRelativePose(
            points1, points2, camera1, camera2, R, t, inliers, scale, covariance, &reason, covariances);
    return std::make_tuple(
            std::make_tuple(found, onlyIf(found, R), onlyIf(found, t), inliers, onlyIf(found, covariance)),
            std::string(reason));
}

typedef Held<cv::iib::ImageAligner> Aligner;

// Whether they show the same, transform, deviations of the corners, matches that agree; why not; the simplest model, and a note.
auto align(const Aligner& aligner, const cv::Mat& image, const cv::Mat& mask)
{
    cv::Mat transform, error, matches;
    cv::String reason, note;
    int simplest = 0;
    const bool found = aligner->align(image, transform, error, matches, &reason, mask, &simplest, &note);
    return std::make_tuple(std::make_tuple(found, onlyIf(found, transform), onlyIf(found, error), matches),
            std::string(reason), simplest, std::string(note));
}

typedef Held<cv::iib::ViewMatcher> ViewMatcher;

// Whether the matches are significant, why not, the view, and rows of the matches.
auto matchViews(const ViewMatcher& matcher, const cv::Mat& image, const cv::Mat& mask)
{
    cv::Mat points1, points2, covariances, similarities, view;
    cv::String reason;
    const bool found =
            matcher->match(image, points1, points2, covariances, similarities, view, mask, &reason);
    return std::make_tuple(
            found, std::string(reason), onlyIf(found, view), points1, points2, covariances, similarities);
}

}  // namespace

void bindFunctions(nb::module_& m)
{
    m.def("estimateRotation", &cv::iib::estimateRotation, WithoutGil());
    m.def("matchRotated", &matchRotated, WithoutGil());
    nb::class_<PreparedImage>(m, "PreparedImage")
            .def(
                    "__init__",
                    [](PreparedImage* self, const cv::Mat& image) { new (self) PreparedImage(image); },
                    WithoutGil());
    m.def("propagateMatches", &propagateMatches<PreparedImage>, WithoutGil());
    m.def("propagateMatches", &propagateMatches<cv::Mat>, WithoutGil());
    m.def("refineMatches", &refineMatches, WithoutGil());
    m.def("findRelativePose", &findRelativePose, WithoutGil());
    m.def(
            "logFalseAlarms",
            [](const cv::Mat& points1, const cv::Mat& points2, const cv::Mat& inliers, bool epipolar,
                    double threshold) {
                return cv::iib::logFalseAlarms(points1, points2, inliers, epipolar, threshold);
            },
            WithoutGil());
    m.def("confidenceLimit", &cv::iib::confidenceLimit);
    m.attr("CERTAIN") = double(cv::iib::Verdict::CERTAIN);
    m.attr("MOST_TURN") = cv::iib::MOST_TURN;
    m.attr("MOST_SCALE") = cv::iib::MOST_SCALE;
    nb::class_<Aligner>(m, "ImageAligner")  // which holds a view of the reference
            .def_static(
                    "create",
                    [](const cv::Mat& reference, int model, const cv::Mat& mask) {
                        return Aligner{cv::iib::ImageAligner::create(reference, model, mask)};
                    },
                    WithoutGil())
            .def("align", &align, WithoutGil());
    nb::class_<ViewMatcher>(m, "ViewMatcher")  // which holds a view of the image
            .def_static(
                    "create",
                    [](const cv::Mat& image, int maxFeatures, double maxTilt, const cv::Mat& mask) {
                        return ViewMatcher{cv::iib::ViewMatcher::create(image, maxFeatures, maxTilt, mask)};
                    },
                    WithoutGil())
            .def("match", &matchViews, WithoutGil());
}

}  // namespace iib_python
