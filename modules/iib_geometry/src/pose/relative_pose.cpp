// SPDX-License-Identifier: Apache-2.0
#include "opencv2/iib/relative_pose.hpp"

#include "pose_fit.hpp"
#include "../common/points.hpp"
#include "uncertainty.hpp"
#include "../verdict/verdict.hpp"

namespace cv::iib {
namespace {

const double LEAST_SCALE = .1, MOST_SCALE = 1000;    // pixels
const double RANK = 1e-13;                           // of covariances in double precision
const double ONE_ROTATION = .05, ONE_DIRECTION = 1;  // radians: two poses less apart are one, not exact

Matx33d cameraMatrix(InputArray matrix, const char* name)
{
    const Mat given = matrix.getMat();
    bool good = given.dims == 2 && given.rows == 3 && given.cols == 3 && given.channels() == 1 &&
                (given.depth() == CV_32F || given.depth() == CV_64F);
    Matx33d K;
    if (good)
    {
        Mat doubles;
        given.convertTo(doubles, CV_64F);
        K = Matx33d(doubles);
        good = checkRange(doubles) && K(0, 0) > 0 && K(1, 1) > 0 && K(0, 1) == 0 && K(1, 0) == 0 &&
               K(2, 0) == 0 && K(2, 1) == 0 && K(2, 2) == 1;
    }
    if (!good)
        CV_Error(Error::StsBadArg, format("findRelativePose: %s must be 3 x 3, CV_32F or CV_64F, [fx 0 cx; 0 "
                                          "fy cy; 0 0 1] in pixels, with "
                                          "fx and fy over 0",
                                           name));
    return K;
}

//! Both N x 2, CV_64F, continuous.
bool isLess(const Mat& points, const Mat& others)
{
    const double *const a = (const double*)points.data, *const b = (const double*)others.data;
    return std::lexicographical_compare(a, a + points.total(), b, b + others.total());
}

/** Of matches with these covariances, for the choice among poses: what was located less exactly says less.
@return none for none. */
std::vector<double> weightsOf(InputArray covariances, int count)
{
    std::vector<double> weights;
    if (covariances.empty())
        return weights;
    Mat rows = covariances.getMat();
    rows = rows.reshape(1, rows.rows);  // of three channels as of three columns
    if ((rows.depth() != CV_32F && rows.depth() != CV_64F) || rows.size() != Size(3, count))
        CV_Error(Error::StsBadArg, format("findRelativePose: covariances must be %d x 3, CV_32F or CV_64F, "
                                          "as refineMatches gives them",
                                           count));
    rows.convertTo(rows, CV_64F);
    for (int i = 0; i < count; i++)
    {
        const double variance =
                rows.at<double>(i, 0) + rows.at<double>(i, 2);  // NaN, infinite: not located at all
        weights.push_back(variance >= 0 ? 1 / std::sqrt(1 + variance) : 0);
    }
    return weights;
}

//! Why the matches tell no pose; empty if they do.
std::string reasonAgainst(const EpipolarProblem& problem, const PoseFit& fit, const Verdict& verdict)
{
    if (fit.squared.empty())
        return "no pose agrees with five matches or more";
    if (fit.logFalseAlarms > Verdict::CERTAIN)
        return format(
                "the pose that agrees best has matches in %d places of the image, no more than chance may "
                "give: the images may not show the same",
                verdict.places(within(3 * std::max(fit.scale, REFINED), fit.squared)));
    if (verdict.isOfOnePart(within(fit.limit, fit.squared), problem.sampleSize(), fit.chance))
        return "the matches that agree are in one small part of the image, and the others do not agree: a "
               "logo, a "
               "caption?";
    return "";
}

//! Matches that agree with a pose, in front of both cameras, and the parts of the image that they are in.
struct Agreeing
{
    EpipolarProblem problem;
    std::vector<int> parts;

    Agreeing(const EpipolarProblem& all, const std::vector<int>& partsOfAll, const Verdict::Marks& marks)
        : problem(all.subset(marks))
    {
        for (size_t i = 0; i < marks.size(); i++)
            if (marks[i])
                parts.push_back(partsOfAll[i]);
    }
};

/** Whether more places agree with the pose than with the other one, by one and by more than chance. Errors are cut off at four scales,
which is a match more; the noise of matches that agree with both, as all of a plane do, is the chance. */
bool leads(const PoseFit& fit, const std::vector<double>& otherSquared, const Verdict& verdict)
{
    const double farthest2 = square(FARTHEST_OF_CHOICE * fit.scale), inside2 = FARTHEST * square(fit.scale);
    const double level = 2;  // standard deviations
    std::vector<double> all(fit.squared.size()), both = all;
    for (size_t i = 0; i < all.size(); i++)
    {
        all[i] = (std::min(otherSquared[i], farthest2) - std::min(fit.squared[i], farthest2)) / farthest2;
        if (std::max(otherSquared[i], fit.squared[i]) < inside2)
            both[i] = all[i];
    }
    double lead = 0, chance2 = 0;
    for (double places : verdict.sumsOfPlaces(all))
        lead += std::clamp(places, -1., 1.);
    for (double places : verdict.sumsOfPlaces(both))
        chance2 += square(places);
    return lead >= 1 + level * std::sqrt(chance2);
}

/** Another pose, far from the errors as the matches around the pose tell them, that explains the matches as well; of several the one that
is turned most.
@param between the step to it. */
bool hasRival(const EpipolarProblem& problem, const PoseFit& fit, const Verdict& verdict,
        const Square<EpipolarProblem::Step>& errors, EpipolarProblem::Step& between)
{
    const double level = 5;  // standard deviations: another pose within them is told by the covariance
    const Square<EpipolarProblem::Step> inverse = errors.inv(DECOMP_SVD);
    double most = -1;
    std::vector<double> squared;
    for (const RelativePose& other : fit.others)
    {
        const EpipolarProblem::Step step = stepBetween(fit.model, other);
        const double turned = norm(Vec3d(step.val));
        if (turned <= most || step.dot(inverse * step) < square(level))
            continue;
        problem.squaredErrors(other, squared);
        if (leads(fit, squared, verdict))
            continue;
        most = turned;
        between = step;
    }
    return most >= 0;
}

/** Whether the direction of t is more than chance. Matches without parallax say nothing of it; of the others one whose parallax is
much longer than the limit agrees with a wrong direction by the chance asin(limit / parallax) 2 / pi. */
bool tellsDirection(const EpipolarProblem& problem, const PoseFit& fit, const Verdict& verdict)
{
    const double limit = 1.5 * std::max(fit.scale, LEAST_SCALE);
    const int matchesOfDirection = 2;
    Verdict::Marks seen(fit.squared.size()), agree = seen;
    double chances = 0, count = 0;
    for (int i = 0; i < problem.size(); i++)
    {
        const double parallax = problem.parallax(fit.model, i);
        if (parallax < 2 * limit)
            continue;
        seen[i] = true;
        agree[i] = fit.squared[i] < limit * limit;
        chances += std::asin(limit / parallax) * 2 / CV_PI;
        count++;
    }
    const double chance = chances / std::max(count, 1.),
                 others = verdict.places(seen) - verdict.places(agree);
    // Here the chance is so large that it counts that the others do not agree.
    return verdict.logFalseAlarms(seen, agree, matchesOfDirection, chance) + others * std::log10(1 - chance) <
           Verdict::CERTAIN;
}

}  // namespace

bool findRelativePose(InputArray points1, InputArray points2, InputArray cameraMatrix1,
        InputArray cameraMatrix2, OutputArray R, OutputArray t, OutputArray inliers, double scale,
        OutputArray covariance, String* reason, InputArray covariances)
{
    Mat first = pointsOf(points1, "findRelativePose", "points1"),
        second = pointsOf(points2, "findRelativePose", "points2");
    checkMatched(first, second, "findRelativePose");
    if (!(scale >= 0) || cvIsInf(scale))
        CV_Error(Error::StsOutOfRange,
                "findRelativePose: scale, in pixels, must be finite and over 0, or 0, to be chosen");
    Matx33d camera1 = cameraMatrix(cameraMatrix1, "cameraMatrix1"),
            camera2 = cameraMatrix(cameraMatrix2, "cameraMatrix2");
    // The answer is the same for swapped images: the one whose points come first in the order of numbers is the first.
    const bool swapped = isLess(second, first);
    if (swapped)
    {
        std::swap(first, second);
        std::swap(camera1, camera2);
    }
    const EpipolarProblem problem(first, second, camera1, camera2);
    const Verdict verdict(first, second);
    PoseFit fit = fitPose(problem, verdict, scale > 0 ? std::clamp(scale, LEAST_SCALE, MOST_SCALE) : 0,
            weightsOf(covariances, first.rows));
    std::string why = reasonAgainst(problem, fit, verdict);
    const Square<EpipolarProblem::Step> anyDirection =
            square(LARGEST_DEVIATION) * Square<EpipolarProblem::Step>::diag({0, 0, 0, 1, 1});
    Square<EpipolarProblem::Step> errors;
    const std::vector<int> parts = partsOf(first);
    double wide = 0;  // errors with long tails are told as large as they are
    if (why.empty())
    {
        wide = fit.limit < 6 * fit.scale ? fit.scale : fit.limit / 3;
        if (scale > 0)
            wide = std::max(wide, widerScale(problem, fit.squared, fit.scale));
        const Verdict::Marks near = within(3 * fit.scale, fit.squared);
        const bool few = std::count(near.begin(), near.end(), true) < FEW;
        if (few && scale == 0)
            fit.scale = wide = std::max(wide, fit.limit / 3);  // few matches tell too narrow a scale
        if (few)
            polish(problem, Loss{fit.scale}, 1e-9, fit.model);
        else
            polish(Agreeing(problem, parts, near).problem, Loss{fit.scale}, 1e-9, fit.model);
        problem.squaredErrors(fit.model, fit.squared);
    }
    if (inliers.needed())
    {
        Mat agree(first.rows, 1, CV_8U, Scalar(0));
        const Verdict::Marks near = within(3 * std::max(fit.scale, REFINED), fit.squared);
        std::copy(near.begin(), near.end(), agree.begin<uchar>());
        agree.copyTo(inliers);
    }
    if (why.empty())
    {
        fit.scale = wide;
        const Verdict::Marks near = within(3 * fit.scale, fit.squared);
        if (std::count(near.begin(), near.end(), true) < FEW)
            errors = covarianceOf(problem, fit, parts, LARGEST_DEVIATION);
        else
        {
            const Agreeing agreeing(problem, parts, near);
            Fit<EpipolarProblem> ofThem;
            ofThem.model = fit.model;
            ofThem.scale = fit.scale;
            errors = covarianceOf(agreeing.problem, ofThem, agreeing.parts, LARGEST_DEVIATION);
        }
        const bool told = tellsDirection(problem, fit, verdict);
        if (!told)
            errors += anyDirection;
        EpipolarProblem::Step between;
        if (hasRival(problem, fit, verdict, errors, between))
        {
            const double turned = norm(Vec3d(between.val)), moved = norm(Vec2d(between.val + 3));
            if (told && turned >= ONE_ROTATION)
                why = format(
                        "two poses explain the matches as well, turned by %.0f and moved in directions by "
                        "%.0f degrees against each other: the points may lie on a plane",
                        turned * 180 / CV_PI, moved * 180 / CV_PI);
            errors += between * between.t();
            if (moved > ONE_DIRECTION)
                errors += anyDirection;
        }
        errors = limited(errors, LARGEST_DEVIATION, RANK);
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
        errors = limited(back * errors * back.t(), LARGEST_DEVIATION, RANK);
        fit.model = inverse(fit.model);
    }
    Mat(fit.model.R).copyTo(R);
    Mat(fit.model.t).copyTo(t);
    if (covariance.needed())
        Mat(errors).copyTo(covariance);
    return true;
}

}  // namespace cv::iib
