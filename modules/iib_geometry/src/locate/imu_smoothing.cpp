// SPDX-License-Identifier: Apache-2.0

#include "opencv2/iib/localization.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <tuple>

#include "../pose/camera_pose.hpp"
#include "../pose/two_views.hpp"
#include "imu_motion.hpp"

namespace cv::iib {
namespace {

constexpr int64 MAX_WITHOUT_POSE = int64(3e9);        // nanoseconds
constexpr int64 MAX_TIME = int64(4e18);               // nanoseconds
constexpr size_t FIRST_FRAMES = 8, LEAST_FRAMES = 4;  // with poses, that initialize the filter
constexpr int64 LEAST_INTERVAL = 200000000;           // nanoseconds between these
constexpr double GRAVITY = 9.81;                      // m/s^2
constexpr double CORRELATED = 5;         // factor of variances: errors of the map's points are correlated
constexpr double MEDIAN_SQUARED = 2.37;  // of chi^2 with three degrees of freedom
constexpr double SLOW_ERRORS = 2;        // variance of all errors over that of the scatter
constexpr double LEAST_SCALE = .01;      // of standard deviations, even without any scatter
// Of chi^2 with six degrees of freedom: one value in a hundred is larger than the first, one in eight than the second.
constexpr double MAX_SQUARED = 16.8, USUAL_SQUARED = 10;
// Limits of the cumulative sum: four outliers in a row end a run; at its end two of six images do, or three of more.
constexpr double MOST_EXCESS = 27, EXCESS_AT_END = 2;
constexpr size_t FEW = 8;    // images that may agree by chance
constexpr size_t MANY = 20;  // images that agree only while the readings are right

//! The pose of the IMU at an image.
struct ImuFrame
{
    int64 nanoseconds;
    std::optional<Affine3d> pose;  //!< world from IMU
    Matx66d covariance;
};

//! The filter's state before and after an image, and the derivatives of its errors since the last one.
struct Step
{
    ImuState expected, state;
    ImuState::Matrix expectedCovariance, covariance, change;
};

//! The matrix H that selects a pose's coordinates, position and rotation, from a state's errors.
Matx<double, 6, ImuState::SIZE> selection()
{
    Matx<double, 6, ImuState::SIZE> H;
    setBlock(H, 0, ImuState::POSITION, Matx33d::eye());
    setBlock(H, 3, ImuState::TURN, Matx33d::eye());
    return H;
}

/** Updates a state by a measured pose: position and rotation about the world's axes (Kalman 1960). With the state's
covariance P, the gain is K = P H' (H P H' + R)^-1, and P' = P - K H P.
@return the innovation's squared Mahalanobis length: chi^2 with six degrees of freedom. */
double update(const Affine3d& pose, const Matx66d& measured, ImuState& state, ImuState::Matrix& covariance)
{
    ImuState seen = state;
    seen.rotation = pose.rotation();
    seen.position = pose.translation();
    const Matx<double, 6, ImuState::SIZE> H = selection();
    const Matx<double, ImuState::SIZE, 6> columns = covariance * H.t();
    const Vec6d offset = H * minus(seen, state);
    Matx66d inverse = (H * columns + CORRELATED * measured).inv(DECOMP_CHOLESKY);
    // The gain of an outlier is reduced until it is plausible.
    const double squared = offset.dot(inverse * offset);
    if (squared > MAX_SQUARED)
        inverse *= MAX_SQUARED / squared;
    const Matx<double, ImuState::SIZE, 6> gain = columns * inverse;
    state = plus(state, gain * offset);
    covariance -= gain * columns.t();
    covariance = .5 * (covariance + covariance.t());
    return squared;
}

/** Estimates gravity g and velocities v by linear least squares (Qin, Li and Shen, VINS-Mono, 2018, section V):
    p' - p - moved = v T + g T^2 / 2,   v' - v - gained = g T
for neighbours T apart. The readings alone give `moved` and `gained`. False if readings are missing. */
bool findStart(const std::vector<int64>& times, const std::vector<Affine3d>& poses,
        const std::vector<ImuReading>& readings, ImuState& start)
{
    const int n = int(times.size());
    Mat a(6 * (n - 1), 3 * n + 3, CV_64F, Scalar(0)), b(6 * (n - 1), 1, CV_64F), x;
    for (int i = 0; i + 1 < n; i++)
    {
        const Affine3d &from = poses[size_t(i)], &to = poses[size_t(i) + 1];
        ImuState moved;  // without gravity and velocity
        moved.rotation = from.rotation();
        moved.position = from.translation();
        if (!integrate(readings, times[size_t(i)], times[size_t(i) + 1], moved, nullptr, nullptr))
            return false;
        const double seconds = double(times[size_t(i) + 1] - times[size_t(i)]) * 1e-9;
        for (int axis = 0; axis < 3; axis++)
        {
            const int row = 6 * i + axis;
            a.at<double>(row, 3 * i + axis) = seconds;
            a.at<double>(row, 3 * n + axis) = seconds * seconds / 2;
            b.at<double>(row) = to.translation()[axis] - moved.position[axis];
            a.at<double>(row + 3, 3 * i + axis) = -1;
            a.at<double>(row + 3, 3 * i + 3 + axis) = 1;
            a.at<double>(row + 3, 3 * n + axis) = -seconds;
            b.at<double>(row + 3) = moved.velocity[axis];
        }
    }
    if (!solve(a, b, x, DECOMP_SVD))
        return false;
    start.velocity = Vec3d(x.ptr<double>(0));
    start.gravity = Vec3d(x.ptr<double>(3 * n));
    start.gravity *= GRAVITY / norm(start.gravity);
    return checkRange(start.gravity);
}

//! The result of filtering from one frame with a pose onwards.
struct Run
{
    std::vector<Step> steps;  //!< of frames in order; empty if the run does not agree with the readings
    bool isShort = false;     //!< too few poses to initialize the filter
    bool ended = false;       //!< by images that the readings contradict
};

//! Runs the filter. A run ends at a gap of readings, three seconds after the last pose, and before contradicted poses.
Run filtered(const std::vector<ImuFrame>& frames, const std::vector<ImuReading>& readings, size_t first)
{
    std::vector<int64> times;
    std::vector<Affine3d> seen;
    for (size_t i = first; i < frames.size() && seen.size() < FIRST_FRAMES; i++)
        if (frames[i].pose && (times.empty() || frames[i].nanoseconds - times.back() >= LEAST_INTERVAL))
        {
            times.push_back(frames[i].nanoseconds);
            seen.push_back(*frames[i].pose);
        }
    Step step;
    step.state.rotation = seen[0].rotation();
    step.state.position = seen[0].translation();
    Run run;
    run.isShort = seen.size() < LEAST_FRAMES;
    if (run.isShort || !findStart(times, seen, readings, step.state))
        return run;
    const double ofParts[] = {1, 1, 1, .02, .2, .2};
    for (int i = 0; i < ImuState::SIZE; i++)
        step.covariance(i, i) = ofParts[i / 3] * ofParts[i / 3];
    update(seen[0], frames[first].covariance, step.state, step.covariance);
    run.steps.push_back(step);
    int64 last = frames[first].nanoseconds;
    double excess = 0;                               // Page's cumulative sum (1954) of innovations
    size_t images = 1, agreed = 1, agreedSteps = 1;  // with poses; images and steps until the sum rose
    for (size_t i = first + 1; i < frames.size() && frames[i].nanoseconds - last <= MAX_WITHOUT_POSE; i++)
    {
        if (!integrate(readings, frames[i - 1].nanoseconds, frames[i].nanoseconds, step.state,
                    &step.covariance, &step.change))
            break;
        step.expected = step.state;
        step.expectedCovariance = step.covariance;
        run.steps.push_back(step);
        if (!frames[i].pose)
            continue;
        const double squared = update(*frames[i].pose, frames[i].covariance, step.state, step.covariance);
        run.steps.back() = step;
        last = frames[i].nanoseconds;
        images++;
        excess = std::max(excess + std::min(MAX_SQUARED, squared) - USUAL_SQUARED, 0.);
        if (excess == 0)
        {
            agreed = images;
            agreedSteps = run.steps.size();
        }
        if (excess > MOST_EXCESS)
            break;
    }
    run.ended = excess > EXCESS_AT_END * double(std::min(images, FEW));
    if (run.ended)
        run.steps.resize(agreed > MANY ? agreedSteps : 0);
    return run;
}

/** Smooths the states of a run by all of its images, in place. From the last back, x += G (x' - expected x') with
G = P F' (expected P')^-1 and F the derivatives of errors (Rauch, Tung and Striebel 1965). */
void smooth(std::vector<Step>& steps)
{
    for (size_t i = steps.size() - 1; i-- > 0;)
    {
        Step& step = steps[i];
        const Step& next = steps[i + 1];
        const ImuState::Matrix gain =
                step.covariance * next.change.t() * next.expectedCovariance.inv(DECOMP_CHOLESKY);
        step.state = plus(step.state, gain * minus(next.state, next.expected));
        step.covariance += gain * (next.covariance - next.expectedCovariance) * gain.t();
    }
}

/** Limits covariances to the scatter of poses (third differences of four in a row, motion included): images with too
wide covariances would agree with any readings. Slow errors do not scatter; SLOW_ERRORS allows for them. */
void limitToScatter(std::vector<ImuFrame>& frames)
{
    std::vector<const ImuFrame*> seen;
    for (const ImuFrame& frame : frames)
        if (frame.pose)
            seen.push_back(&frame);
    std::vector<double> squared[2];  // Mahalanobis lengths of the differences of positions and of rotations
    for (size_t i = 0; i + 3 < seen.size(); i++)
    {
        const ImuFrame* const* const four = &seen[i];
        Vec3d off[2];
        Matx66d variance = Matx66d::zeros();
        for (int a = 0; a < 4; a++)
        {
            double weight = 1;
            for (int b = 0; b < 4; b++)
                if (b != a)
                    weight *= 1e9 / double(four[a]->nanoseconds - four[b]->nanoseconds);
            off[0] += weight * (four[a]->pose->translation() - four[0]->pose->translation());
            off[1] += weight * Affine3d(four[a]->pose->rotation() * four[0]->pose->rotation().t()).rvec();
            variance += weight * weight * four[a]->covariance;
        }
        for (int k = 0; k < 2; k++)
            squared[k].push_back(
                    off[k].dot(variance.get_minor<3, 3>(3 * k, 3 * k).inv(DECOMP_CHOLESKY) * off[k]));
    }
    Matx66d scale = Matx66d::eye();
    for (int k = 0; k < 6; k++)
        if (!squared[k / 3].empty())
            scale(k, k) = std::clamp(
                    std::sqrt(SLOW_ERRORS * median(squared[k / 3]) / MEDIAN_SQUARED), LEAST_SCALE, 1.);
    for (ImuFrame& frame : frames)
        frame.covariance = scale * frame.covariance * scale;
}

//! The IMU's pose by an image's pose.
ImuFrame imuFrame(int64 time, const Location& image, const Affine3d& cameraFromImu)
{
    if (!image.found)
        return {time, std::nullopt, {}};
    const Affine3d camera = inverse(image.cameraFromWorld);
    return {time, camera * cameraFromImu,
            covarianceAt(image.covariance, camera.rotation() * cameraFromImu.translation())};
}

//! The covariance of the camera's pose in a state.
Matx66d ofCamera(const Step& step, const Affine3d& imuFromCamera)
{
    const Matx66d covariance = selection() * step.covariance * selection().t();
    return covarianceAt(covariance, step.state.rotation * imuFromCamera.translation());
}

//! Whether an image's pose is finite and its covariance is positive definite.
bool isValid(const Location& image)
{
    Vec6d variances;
    return checkRange(image.cameraFromWorld.matrix) && checkRange(image.covariance) &&
           eigen(image.covariance, variances) && variances[5] > 0;
}

//! Checks that times rise, and that their differences do not overflow.
void checkTimes(const std::vector<int64>& times, const char* what)
{
    for (size_t i = 0; i < times.size(); i++)
        if (times[i] > MAX_TIME || times[i] < -MAX_TIME || (i > 0 && times[i] <= times[i - 1]))
            CV_Error(Error::StsBadArg,
                    format("%s %d has the time %s: times must be nanoseconds, of at most 19 digits, and rise",
                            what, int(i), std::to_string(times[i]).c_str()));
}

void checkArguments(const std::vector<int64>& times, const std::vector<Location>& images,
        const std::vector<ImuReading>& readings, const Affine3d& imuFromCamera)
{
    if (times.size() != images.size())
        CV_Error(Error::StsUnmatchedSizes,
                format("there are %d times of %d images", int(times.size()), int(images.size())));
    checkTimes(times, "image");
    std::vector<int64> measured;
    for (const ImuReading& reading : readings)
    {
        measured.push_back(reading.nanoseconds);
        if (!checkRange(reading.rate) || !checkRange(reading.force))
            CV_Error(Error::StsBadArg, "a reading of the IMU is not finite");
    }
    checkTimes(measured, "reading");
    const Matx33d turn = imuFromCamera.rotation();
    if (!checkRange(imuFromCamera.matrix) || !(norm(turn * turn.t() - Matx33d::eye()) < .01) ||
            determinant(turn) < 0)
        CV_Error(Error::StsBadArg, "imuFromCamera must be a finite rotation and translation");
}

}  // namespace

std::string smoothPoses(const std::vector<int64>& times, std::vector<Location>& images,
        const std::vector<ImuReading>& readings, const Affine3d& imuFromCamera)
{
    checkArguments(times, images, readings, imuFromCamera);
    std::vector<ImuFrame> frames;
    for (size_t i = 0; i < images.size(); i++)
    {
        if (images[i].found && !isValid(images[i]))
            return format("image %d has an invalid pose or covariance (not finite, or zero), so that it "
                          "cannot be weighed against the readings: all poses stay as they are",
                    int(i));
        frames.push_back(imuFrame(times[i], images[i], inverse(imuFromCamera)));
    }
    limitToScatter(frames);
    std::vector<std::optional<std::pair<Affine3d, Matx66d>>> smoothed(frames.size());
    // Images with poses. A few in a row may agree by chance.
    size_t agree = 0, contradict = 0, tooFew = 0, poses = 0, staying = 0;
    for (size_t i = 0; i < frames.size();)
    {
        Run run;
        if (frames[i].pose)
            run = filtered(frames, readings, i);
        contradict += run.ended;
        tooFew += run.isShort;
        const size_t first = i++;
        if (run.steps.empty())
            continue;
        smooth(run.steps);
        size_t count = 0;
        Matx66d ofImages;  // of the last image with a pose: the filter does not see errors that images share
        for (i = first; i < first + run.steps.size(); i++)
        {
            const Step& step = run.steps[i - first];
            count += images[i].found;
            if (images[i].found)
                ofImages = images[i].covariance;
            smoothed[i] = {inverse(Affine3d(step.state.rotation, step.state.position) * imuFromCamera),
                    images[i].found ? ofImages : ofImages + ofCamera(step, imuFromCamera)};
        }
        (count > FEW ? agree : tooFew) += count;
        i += run.ended;  // skips the contradicted image
    }
    if (contradict > 0 && agree <= contradict + tooFew)
        return "the readings of the IMU contradict the images, whose poses stay as they are: check the IMU's "
               "axes and units (radians a second, m/s^2), its clock, imuFromCamera and that the map is in "
               "metres";
    for (size_t i = 0; i < images.size(); i++)
    {
        poses += images[i].found;
        staying += images[i].found && !smoothed[i];
        if (!smoothed[i])
            continue;
        images[i].found = true;
        images[i].reason = "";
        std::tie(images[i].cameraFromWorld, images[i].covariance) = *smoothed[i];
    }
    return contradict == 0
                   ? ""
                   : format("the readings of the IMU contradict images: %d of %d poses stay as they are",
                             int(staying), int(poses));
}

}  // namespace cv::iib
