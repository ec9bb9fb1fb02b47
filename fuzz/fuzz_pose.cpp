// SPDX-License-Identifier: Apache-2.0

// findRelativePose, with covariances too, logFalseAlarms and the fits of alignImages with any matches: repeated,
// collinear, huge, tiny or none. Expects a cv::Exception for invalid arguments, otherwise a reason, or a rotation, a
// direction and a covariance.

#include "byte_source.hpp"
#include "pose/planar_problem.hpp"
#include "pose/uncertainty.hpp"

#include "opencv2/iib/relative_pose.hpp"
#include "opencv2/iib/verdict.hpp"

#include <cmath>

namespace {

using namespace cv;
using namespace cv::iib;

const int MOST = 40;
const double FARTHEST_POINT = 1e9;  // largest valid coordinate

double drawNumber(ByteSource& in, double usual) { return in.rarely(32) ? in.number() : usual; }

//! Matches of one kind and size, with a few arbitrary numbers. Inputs with many outliers are rare, since they are slow.
void drawMatches(ByteSource& in, Mat& first, Mat& second)
{
    const int kind = in.between(0, 4);
    const bool slow = in.rarely(64);
    const int count = in.between(0, slow ? MOST : kind == 4 ? 7 : 14);
    const double size = std::pow(10., in.rarely(8) ? in.between(-12, 9) : 0);
    RNG random(in.read<uchar>() + 1);
    const double noise = in.between(0, 8) / (slow ? 4. : 32.);
    const Vec3d t = in.flag() ? Vec3d(.3, .1, 0) : Vec3d();
    first.create(count, 2, CV_64F);
    second.create(count, 2, CV_64F);
    for (int i = 0; i < count; i++)
    {
        Vec3d X(random.uniform(-2., 2.), random.uniform(-1.5, 1.5), random.uniform(3., 9.));
        if (kind == 1)  // on a line
            X = Vec3d(X[0], .2 * X[0], 5 + .3 * X[0]);
        if (kind == 2)  // on a plane
            X[2] = 5 + .2 * X[0];
        if (kind == 3)  // in one place
            X = Vec3d(.1, .2, 4);
        const Vec3d Y = X + t;
        for (int c = 0; c < 2; c++)
        {
            const double a = 320 + 500 * X[c] / X[2] + random.gaussian(noise),
                         b = kind == 4 ? random.uniform(0., 640.)
                                       : 320 + 500 * Y[c] / Y[2] + random.gaussian(noise);
            first.at<double>(i, c) = drawNumber(in, a * size);
            second.at<double>(i, c) = drawNumber(in, b * size);
        }
    }
    if (in.rarely(64) && count > 0)
        second = second.rowRange(1, count).clone();
}

bool arePoints(const Mat& points)
{
    return checkRange(points, true, nullptr, -FARTHEST_POINT, FARTHEST_POINT);
}

void checkPose(
        ByteSource& in, const Mat& first, const Mat& second, bool valid, const Mat& covariances = Mat())
{
    const double focal = drawNumber(in, in.flag() ? 500 : std::pow(10., in.between(-3, 6))),
                 scale = in.flag() ? 0 : drawNumber(in, in.between(0, 40) / 8.);
    const Matx33d K(focal, 0, 320, 0, 500, 240, 0, 0, 1);
    valid = valid && std::isfinite(focal) && focal > 0 && std::isfinite(scale) && scale >= 0;
    Mat R, t, inliers, covariance;
    String reason;
    bool found = false;
    const bool thrown = refused([&] {
        found = findRelativePose(first, second, K, K, R, t, inliers, scale, covariance, &reason, covariances);
    });
    FUZZ_CHECK(thrown == !valid);
    if (thrown)
        return;
    FUZZ_CHECK((int)inliers.total() == first.rows && found == reason.empty());
    if (!found)
    {
        FUZZ_CHECK(R.empty() && t.empty() && covariance.empty());
        return;
    }
    const Matx33d rotation(R);
    FUZZ_CHECK(norm(rotation * rotation.t() - Matx33d::eye()) < 1e-9 && determinant(rotation) > 0);
    FUZZ_CHECK(std::abs(norm(t) - 1) < 1e-9);
    Mat values;
    FUZZ_CHECK(checkRange(covariance) && norm(covariance, covariance.t()) <= 1e-9 * norm(covariance));
    eigen(covariance, values);
    FUZZ_CHECK(values.at<double>(4) > 0);
}

void checkVerdict(ByteSource& in, const Mat& first, const Mat& second, bool valid)
{
    Mat marks(first.rows, 1, CV_8U);
    for (int i = 0; i < marks.rows; i++)
        marks.at<uchar>(i) = in.rarely(3) ? 0 : 1;
    const double threshold = drawNumber(in, 1);
    valid = valid && std::isfinite(threshold) && threshold > 0;
    double alarms = 0;
    const bool epipolar = in.flag(),
               thrown = refused([&] { alarms = logFalseAlarms(first, second, marks, epipolar, threshold); });
    FUZZ_CHECK(thrown == !valid && !std::isnan(alarms));
}

void checkTransform(ByteSource& in, const Points& first, const Points& second)
{
    const PlanarProblem problem(first, second, in.between(0, 3));
    const Fit<PlanarProblem> fit = robustFit(problem);
    if (fit.squared.empty())
        return;
    Mat values;
    const Mat covariance(covarianceOf(problem, fit.model, fit.scale, partsOf(first), 1e6));
    FUZZ_CHECK(checkRange(problem.inPixels(fit.model)) && checkRange(covariance));
    eigen(covariance, values);
    FUZZ_CHECK(values.at<double>(values.rows - 1) >= -1e-9 * values.at<double>(0));
}

}  // namespace

FUZZ_TARGET
{
    Mat first, second;
    drawMatches(in, first, second);
    const bool valid = first.rows == second.rows && arePoints(first) && arePoints(second);
    checkPose(in, first, second, valid);
    checkVerdict(in, first, second, valid);
    if (valid)
        checkTransform(
                in, pointsOf(first, "checkTransform", "first"), pointsOf(second, "checkTransform", "second"));
    if (in.rarely(4))
    {
        Mat_<double> covariances(first.rows, in.rarely(16) ? 2 : 3);
        for (double& each : covariances)
            each = drawNumber(in, in.between(0, 40) / 40.);
        checkPose(in, first, second, valid && (covariances.empty() || covariances.cols == 3), covariances);
    }
}
