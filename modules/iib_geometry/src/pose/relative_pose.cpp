// SPDX-License-Identifier: Apache-2.0
#include "opencv2/iib/relative_pose.hpp"

#include "epipolar_problem.hpp"
#include "../common/points.hpp"
#include "uncertainty.hpp"
#include "../verdict/verdict.hpp"

namespace cv::iib {
namespace {

const double LEAST_SCALE = .1, MOST_SCALE = 1000;    // pixels
const double RANK = 1e-13;                           // of covariances in double precision
const double ONE_ROTATION = .05, ONE_DIRECTION = 1;  // radians: two poses less apart are one, not exact
const double REFINED = .25;                          // least scale by which matches count as agreeing, pixels

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

/** Why the matches tell no pose; empty if they do.
@param limit the distance, pixels, within which they agree by the least chance. */
std::string reasonAgainst(const EpipolarProblem& problem, const Fit<EpipolarProblem>& fit,
        const Verdict& verdict, double& limit)
{
    if (fit.squared.empty())
        return "no pose agrees with five matches or more";
    std::vector<double> limits;
    for (double scales : {1.5, 3., 6., 12.})
        limits.push_back(scales * std::max(fit.scale, REFINED));
    if (verdict.logFalseAlarms(fit.squared, errorsOfWrongMatches(problem, fit.model), Verdict::FROM_LINE, 5,
                limits, &limit) > Verdict::CERTAIN)
        return format(
                "the pose that agrees best has matches in %d places of the image, no more than chance may "
                "give: the images may not show the same",
                verdict.places(within(limits[1], fit.squared)));
    return "";
}

//! The scale that the errors tell, if it is wider than the one that was given.
double scaleOf(const EpipolarProblem& problem, const Fit<EpipolarProblem>& fit)
{
    for (double scale = fit.scale, told; scale <= problem.mostScale(); scale *= 2)
        if (settles(fit.squared, FARTHEST_OF_CHOICE * scale, problem.parameters(), told))
            return told;
    return fit.scale;
}

//! Polishes the pose under a wider scale where few matches are within the one that they told: it may be too narrow.
void polishFew(const EpipolarProblem& problem, double scale, Fit<EpipolarProblem>& fit)
{
    const int few = 30;
    const Verdict::Marks near = within(3 * fit.scale, fit.squared);
    if (std::count(near.begin(), near.end(), true) >= few)
        return;
    fit.scale = scale;
    polish(problem, scale, 1e-9, fit.model);
    problem.squaredErrors(fit.model, fit.squared);
}

/** Whether more places agree with the pose than with the other one, by one and by more than chance. Errors are cut off at four scales,
which is a match more; the noise of matches that agree with both, as all of a plane do, is the chance. */
bool leads(const Fit<EpipolarProblem>& fit, const Verdict& verdict)
{
    const double farthest2 = square(FARTHEST_OF_CHOICE * fit.scale), inside2 = FARTHEST * square(fit.scale);
    const double level = 2;  // standard deviations
    std::vector<double> all(fit.squared.size()), both = all;
    for (size_t i = 0; i < all.size(); i++)
    {
        all[i] = (std::min(fit.otherSquared[i], farthest2) - std::min(fit.squared[i], farthest2)) / farthest2;
        if (std::max(fit.otherSquared[i], fit.squared[i]) < inside2)
            both[i] = all[i];
    }
    double lead = 0, chance2 = 0;
    for (double places : verdict.sumsOfPlaces(all))
        lead += std::clamp(places, -1., 1.);
    for (double places : verdict.sumsOfPlaces(both))
        chance2 += square(places);
    return lead >= 1 + level * std::sqrt(chance2);
}

//! Whether another pose explains the matches as well and is none that the errors tell of, as the matches around the pose tell them.
bool hasRival(
        const Fit<EpipolarProblem>& fit, const Verdict& verdict, const Square<EpipolarProblem::Step>& errors)
{
    const double level = 5;  // standard deviations: another pose within them is told by the covariance
    if (fit.otherSquared.empty() || leads(fit, verdict))
        return false;
    const EpipolarProblem::Step between = stepBetween(fit.model, fit.other);
    return between.dot(errors.inv(DECOMP_SVD) * between) >= square(level);
}

/** Whether the direction of t is more than chance. Matches without parallax say nothing of it; of the others one whose parallax is
much longer than the limit agrees with a wrong direction by the chance asin(limit / parallax) 2 / pi. */
bool tellsDirection(const EpipolarProblem& problem, const Fit<EpipolarProblem>& fit, const Verdict& verdict)
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
    return verdict.logFalseAlarms(seen, agree, matchesOfDirection, chances / std::max(count, 1.)) <
           Verdict::CERTAIN;
}

}  // namespace

bool findRelativePose(InputArray points1, InputArray points2, InputArray cameraMatrix1,
        InputArray cameraMatrix2, OutputArray R, OutputArray t, OutputArray inliers, double scale,
        OutputArray covariance, String* reason)
{
    const Mat first = pointsOf(points1, "findRelativePose", "points1"),
              second = pointsOf(points2, "findRelativePose", "points2");
    checkMatched(first, second, "findRelativePose");
    if (!(scale >= 0) || cvIsInf(scale))
        CV_Error(Error::StsOutOfRange,
                "findRelativePose: scale, in pixels, must be finite and over 0, or 0, to be chosen");
    const EpipolarProblem problem(first, second, cameraMatrix(cameraMatrix1, "cameraMatrix1"),
            cameraMatrix(cameraMatrix2, "cameraMatrix2"));
    Fit<EpipolarProblem> fit = robustFit(problem, scale > 0 ? std::clamp(scale, LEAST_SCALE, MOST_SCALE) : 0);
    const Verdict verdict(first, second);
    double limit = 0;
    std::string why = reasonAgainst(problem, fit, verdict, limit);
    double wide = 0;  // errors with long tails are told as large as they are
    if (why.empty())
    {
        wide = limit < 6 * fit.scale ? fit.scale : limit / 3;
        if (scale == 0)
            polishFew(problem, wide, fit);
        else
            wide = std::max(wide, scaleOf(problem, fit));
    }
    if (inliers.needed())
    {
        Mat agree(first.rows, 1, CV_8U, Scalar(0));
        const Verdict::Marks near = within(3 * std::max(fit.scale, REFINED), fit.squared);
        std::copy(near.begin(), near.end(), agree.begin<uchar>());
        agree.copyTo(inliers);
    }
    Square<EpipolarProblem::Step> errors;
    if (why.empty())
    {
        fit.scale = wide;
        errors = covarianceOf(problem, fit, partsOf(first), LARGEST_DEVIATION);
        const bool told = tellsDirection(problem, fit, verdict);
        const Square<EpipolarProblem::Step> anyDirection =
                square(LARGEST_DEVIATION) * Square<EpipolarProblem::Step>::diag({0, 0, 0, 1, 1});
        if (!told)
            errors += anyDirection;
        if (hasRival(fit, verdict, errors))
        {
            const EpipolarProblem::Step between = stepBetween(fit.model, fit.other);
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
    Mat(fit.model.R).copyTo(R);
    Mat(fit.model.t).copyTo(t);
    if (covariance.needed())
        Mat(errors).copyTo(covariance);
    return true;
}

}  // namespace cv::iib
