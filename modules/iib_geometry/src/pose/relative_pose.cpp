// SPDX-License-Identifier: Apache-2.0
#include "opencv2/iib/relative_pose.hpp"

#include <tuple>

#include "pose_fit.hpp"
#include "uncertainty.hpp"
#include "../verdict/pose_tests.hpp"

namespace cv::iib {
namespace {

const double LEAST_SCALE = .1, MOST_SCALE = 1000;  // pixels
const double RANK = 1e-13;                         // keeps covariances invertible in double precision
const double OF_DIRECTION = 1.3;  // true over estimated variance of t, fitted on rendered places
const double ONE_DIRECTION = 1;   // radians: if two possible t differ by more, t is unknown

Matx33d cameraMatrix(InputArray matrix, const char* name)
{
    const Mat given = matrix.getMat();
    Matx33d K;
    if (given.size() == Size(3, 3) && (given.type() == CV_32F || given.type() == CV_64F))
        given.convertTo(K, CV_64F);
    if (!checkRange(K) || !(K(0, 0) > 0 && K(1, 1) > 0) ||
            K != Matx33d(K(0, 0), 0, K(0, 2), 0, K(1, 1), K(1, 2), 0, 0, 1))
        CV_Error(Error::StsBadArg,
                format("findRelativePose: %s must be 3 x 3, CV_32F or CV_64F, [fx 0 cx; 0 fy cy; 0 0 1] in "
                       "pixels, with fx and fy over 0",
                        name));
    return K;
}

bool isLess(const Points& points, const Points& others)
{
    return std::lexicographical_compare(points.begin(), points.end(), others.begin(), others.end(),
            [](const Point2d& a, const Point2d& b) { return std::tie(a.x, a.y) < std::tie(b.x, b.y); });
}

/** Weights of the matches for the choice among poses: less accurate matches count less.
@return empty without covariances. */
std::vector<double> weightsOf(InputArray covariances, int count)
{
    std::vector<double> weights;
    if (covariances.empty())
        return weights;
    Mat rows = covariances.getMat();
    rows = rows.reshape(1, rows.rows);  // three channels are three columns
    if ((rows.depth() != CV_32F && rows.depth() != CV_64F) || rows.size() != Size(3, count))
        CV_Error(Error::StsBadArg, format("findRelativePose: covariances must be %d x 3, CV_32F or CV_64F, "
                                          "as refineMatches gives them",
                                           count));
    rows.convertTo(rows, CV_64F);
    for (int i = 0; i < count; i++)
    {
        const double variance = rows.at<double>(i, 0) + rows.at<double>(i, 2);
        weights.push_back(variance >= 0 ? 1 / std::sqrt(1 + variance) : 0);  // no weight for NaN and infinity
    }
    return weights;
}

//! The estimated errors of a pose.
struct PoseErrors
{
    Square<EpipolarProblem::Step> covariance;
    EpipolarProblem::Step rival;  //!< step to another pose that explains the matches as well; 0 without one
};

/** Estimates the covariance of a pose from its matches, then enlarges it if the direction of t is not significant, or if other poses
explain the matches as well. */
PoseErrors estimateErrors(
        const EpipolarProblem& problem, const PoseFit& fit, const Points& points, const Verdict& verdict)
{
    const double level = 5;                     // standard deviations: a pose within them is no rival
    const double ofPlane = .05, ofOthers = .1;  // radians: a pose rotated by less enlarges the error only
    const Square<EpipolarProblem::Step> anyDirection =
            square(LARGEST_DEVIATION) * Square<EpipolarProblem::Step>::diag({0, 0, 0, 1, 1});
    std::vector<int> parts;
    const std::vector<int> partsOfAll = partsOf(points);
    std::vector<double> squared;
    for (int i = 0; i < problem.size(); i++)
        if (fit.used[i])
            parts.push_back(partsOfAll[i]);
    PoseErrors errors;
    const double deviation = std::sqrt(OF_DIRECTION);
    const auto scales = Square<EpipolarProblem::Step>::diag({1, 1, 1, deviation, deviation});
    errors.covariance =
            covarianceOf(problem.subset(fit.used), fit.model, fit.errorScale, parts, LARGEST_DEVIATION);
    errors.covariance = scales * errors.covariance * scales;
    const double limit = 1.5 * (fit.errorScale > LEAST_SCALE ? fit.errorScale
                                                             : scaleWithin(fit.squared, 3 * LEAST_SCALE,
                                                                       problem.parameters(), LEAST_NOISE));
    const bool hasDirection = isDirectionCertain(
            fit.squared, problem.leastParallaxes(fit.model, fit.squared, limit), limit, verdict, -1);
    // A milder test: no rotation minimizes the parallaxes first.
    const bool hasParallax = isDirectionCertain(fit.squared, problem.parallaxes(fit.model), limit, verdict);
    if (!hasDirection)
        errors.covariance += anyDirection;
    const Square<EpipolarProblem::Step> expected = errors.covariance.inv(DECOMP_SVD);
    for (size_t k = 0; k < fit.others.size(); k++)
    {
        const EpipolarProblem::Step step = stepBetween(fit.model, fit.others[k]);
        if (step.dot(expected * step) < square(level))
            continue;
        problem.squaredErrors(fit.others[k], squared);
        if (explainsMore(fit.squared, squared, fit.errorScale, verdict))
            continue;
        const double turned = norm(Vec3d(step.val));
        if (hasParallax && turned >= (k < fit.planar ? ofPlane : ofOthers) &&
                turned > norm(Vec3d(errors.rival.val)))
            errors.rival = step;
        if (step.dot(errors.covariance.inv(DECOMP_SVD) * step) > 1)  // then it is one standard deviation away
            errors.covariance += step * step.t();
        if (norm(Vec2d(step.val + 3)) > ONE_DIRECTION)
            errors.covariance += anyDirection;
    }
    errors.covariance = limited(errors.covariance, LARGEST_DEVIATION, RANK);
    return errors;
}

/** Logarithm of the number of poses that would agree as well with matches displaced at random. Many poses have their epipolar lines near such
matches. So only matches in a wide band around the lines are counted: displaced ones are uniformly distributed across it. */
double logFalseAlarmsNearby(const EpipolarProblem& problem, const PoseFit& fit, const Verdict& verdict)
{
    const double wide = std::max(5 * problem.mostScale(), 3 * fit.limit);  // pixels
    return verdict.logFalseAlarms(within(wide, fit.squared), within(fit.limit, fit.squared),
            problem.sampleSize(), fit.limit / wide);
}

//! Why the pose is refused; empty if it is accepted.
std::string reasonAgainst(
        const EpipolarProblem& problem, const PoseFit& fit, const PoseErrors& errors, const Verdict& verdict)
{
    if (fit.squared.empty())
        return "no pose agrees with five matches or more";
    if (fit.logFalseAlarms > Verdict::CERTAIN)
        return format("the pose that agrees best has matches in %d places of the image, which could be "
                      "random: the images may not show the same scene",
                verdict.places(within(3 * std::max(fit.scale, REFINED), fit.squared)));
    const double most = 1;  // ten such poses: eight right matches, inexact ones, show no less
    if (logFalseAlarmsNearby(problem, fit, verdict) > most)
        return "the matches are near their epipolar lines, but not nearer than if they were displaced at "
               "random: they may be inexact, or the images may not show the same";
    if (verdict.isOfSmallParts(within(fit.limit, fit.squared), problem.sampleSize(), fit.chance))
        return "the matches that agree are in small parts of the image, and the others do not agree: a "
               "logo, a caption?";
    if (errors.rival != EpipolarProblem::Step())
        return format("two poses explain the matches as well, turned by %.0f and moved in directions by "
                      "%.0f degrees against each other: the points may lie on a plane",
                norm(Vec3d(errors.rival.val)) * 180 / CV_PI, norm(Vec2d(errors.rival.val + 3)) * 180 / CV_PI);
    return "";
}

}  // namespace

bool findRelativePose(InputArray points1, InputArray points2, InputArray cameraMatrix1,
        InputArray cameraMatrix2, OutputArray R, OutputArray t, OutputArray inliers, double scale,
        OutputArray covariance, String* reason, InputArray covariances)
{
    Points first = pointsOf(points1, "findRelativePose", "points1"),
           second = pointsOf(points2, "findRelativePose", "points2");
    checkMatched(first, second, "findRelativePose");
    if (!(scale >= 0) || cvIsInf(scale))
        CV_Error(Error::StsOutOfRange,
                "findRelativePose: scale, in pixels, must be finite and over 0, or 0, to be chosen");
    Matx33d camera1 = cameraMatrix(cameraMatrix1, "cameraMatrix1"),
            camera2 = cameraMatrix(cameraMatrix2, "cameraMatrix2");
    // Sorts the images by their points, so that swapped images get the inverse pose exactly.
    const bool swapped = isLess(second, first);
    if (swapped)
    {
        std::swap(first, second);
        std::swap(camera1, camera2);
    }
    const EpipolarProblem problem(first, second, camera1, camera2);
    const Verdict verdict(first, second);
    PoseFit fit = fitPose(problem, verdict, scale > 0 ? std::clamp(scale, LEAST_SCALE, MOST_SCALE) : 0,
            weightsOf(covariances, problem.size()));
    PoseErrors errors;
    if (fit.logFalseAlarms < Verdict::CERTAIN)
        errors = estimateErrors(problem, fit, first, verdict);
    const std::string why = reasonAgainst(problem, fit, errors, verdict);
    if (inliers.needed())
    {
        Mat agree(problem.size(), 1, CV_8U, Scalar(0));
        const Verdict::Marks near = within(3 * std::max(fit.scale, REFINED), fit.squared);
        std::copy(near.begin(), near.end(), agree.begin<uchar>());
        agree.copyTo(inliers);
    }
    if (reason)
        *reason = why;
    if (!why.empty())
    {
        for (const _OutputArray* output : {&R, &t, &covariance})
            clear(*output);
        return false;
    }
    if (swapped)
    {
        const Matx<double, 5, 5> back = stepOfInverse(fit.model);
        errors.covariance = limited(back * errors.covariance * back.t(), LARGEST_DEVIATION, RANK);
        fit.model = inverse(fit.model);
    }
    Mat(fit.model.R).copyTo(R);
    Mat(fit.model.t).copyTo(t);
    if (covariance.needed())
        Mat(errors.covariance).copyTo(covariance);
    return true;
}

}  // namespace cv::iib
