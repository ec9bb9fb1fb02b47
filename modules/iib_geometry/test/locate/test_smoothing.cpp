// SPDX-License-Identifier: Apache-2.0

#include <limits>
#include <random>

#include "../derivatives.hpp"
#include "locate/imu_motion.hpp"
#include "../test_folder.hpp"

namespace opencv_test { namespace {
using namespace cv::iib;

const cv::Vec3d GRAVITY(0, 9.81 * 0.8, 9.81 * 0.6);  // along no axis of the world
const int64 SECOND = 1000000000;
const cv::Vec3d RATE_BIAS(0.003, -0.002, 0.004), FORCE_BIAS(0.03, -0.02, 0.04);

//! A smooth path of the IMU, as a function of seconds.
cv::Affine3d poseAt(double t)
{
    const cv::Matx33d turn = cv::Affine3d(cv::Vec3d(0, 0.3 * std::sin(0.9 * t), 0)).rotation() *
                             cv::Affine3d(cv::Vec3d(0.1 * std::sin(1.7 * t), 0, 0)).rotation();
    return {turn, cv::Vec3d(0.5 * std::sin(0.8 * t), 0.1 * std::sin(2 * t), 1.2 * t + 0.2 * std::sin(t))};
}

std::vector<ImuReading> readingsUntil(double seconds)
{
    std::vector<ImuReading> readings;
    const double h = 1e-4;
    for (int64 time = 0; time <= int64(seconds * 1e9); time += SECOND / 200)
    {
        const double t = double(time) * 1e-9;
        const cv::Affine3d before = poseAt(t - h), now = poseAt(t), after = poseAt(t + h);
        const cv::Vec3d turn = cv::Affine3d(before.rotation().t() * after.rotation()).rvec();
        const cv::Vec3d acceleration =
                (before.translation() - 2 * now.translation() + after.translation()) / (h * h);
        readings.push_back({time, turn / (2 * h) + RATE_BIAS,
                now.rotation().t() * (acceleration - GRAVITY) + FORCE_BIAS});
    }
    return readings;
}

const char* const CONTRADICTS =
        "the readings of the IMU contradict the images, whose poses stay as they are: check "
        "the IMU's axes and units (radians a second, m/s^2), its clock, imuFromCamera "
        "and that the map is in metres";

//! Images `step` nanoseconds apart, whose poses have errors of about 1 cm and 0.1 degrees, multiplied by `times`.
struct Drive
{
    std::vector<int64> times;
    std::vector<Location> images;
    cv::Affine3d imuFromCamera;

    explicit Drive(double seconds, int64 step = SECOND / 2, double off = 1,
            const cv::Affine3d& camera = cv::Affine3d::Identity())
        : imuFromCamera(camera)
    {
        std::mt19937 random(1);
        std::normal_distribution<double> metres(0, 0.006 * off), radians(0, 0.0015 * off);
        for (int64 time = 0; time <= int64(seconds * 1e9); time += step)
        {
            const cv::Affine3d truth = poseAt(double(time) * 1e-9) * imuFromCamera;
            cv::Vec3d moved, turned;
            for (int k : {2, 1, 0})
                moved[k] = metres(random);
            for (int k : {2, 1, 0})
                turned[k] = radians(random);
            Location image;
            image.found = true;
            image.cameraFromWorld = cv::Affine3d(
                    cv::Affine3d(turned).rotation() * truth.rotation(), truth.translation() + moved)
                                            .inv();
            for (int i = 0; i < 6; i++)  // too small by CORRELATED, as of a map with correlated errors
                image.covariance(i, i) = std::pow((i < 3 ? 0.006 : 0.0015) * off, 2) / 5;
            times.push_back(time);
            images.push_back(image);
        }
    }

    void forget(size_t from, size_t to)
    {
        for (size_t i = from; i < to; i++)
            images[i].found = false;
    }

    //! Keeps every fourth pose.
    void forgetMost()
    {
        for (size_t i = 0; i < images.size(); i += 4)
            forget(i + 1, std::min(i + 4, images.size()));
    }

    void moveWrongly(size_t i)
    {
        cv::Affine3d& wrong = images[i].cameraFromWorld;
        wrong = wrong.translate(wrong.rotation() * cv::Vec3d(-.8, 0, 0));
    }

    std::vector<Location> smoothed(
            const std::vector<ImuReading>& readings, const std::string& reason = "") const
    {
        std::vector<Location> result = images;
        EXPECT_EQ(reason, smoothPoses(times, result, readings, imuFromCamera));
        return result;
    }

    void expectUnchanged(const std::vector<ImuReading>& readings, const std::string& reason) const
    {
        const std::vector<Location> found = smoothed(readings, reason);
        for (size_t i = 0; i < images.size(); i++)
        {
            EXPECT_EQ(images[i].found, found[i].found) << i;
            EXPECT_EQ(images[i].cameraFromWorld.matrix, found[i].cameraFromWorld.matrix) << i;
        }
    }

    //! Metres; 1000 without a pose.
    double errorOf(size_t i, const Location& image) const
    {
        const cv::Affine3d imu = (imuFromCamera * image.cameraFromWorld).inv();
        return image.found ? cv::norm(imu.translation() - poseAt(double(times[i]) * 1e-9).translation())
                           : 1000;
    }

    //! Mean over the images from `from` on.
    double meanError(const std::vector<Location>& found, size_t from = 0) const
    {
        double sum = 0;
        for (size_t i = from; i < found.size(); i++)
            sum += errorOf(i, found[i]);
        return sum / double(found.size() - from);
    }
};

// Each block is accurate to its lowest order in dt. Rows are divided by that order; higher orders are a thousandth of
// it.
TEST(Smoothing, derivatives_match_finite_differences)
{
    typedef ImuState S;
    S::Errors begin;
    for (int i = 0; i < S::SIZE; i++)
        begin[i] = .1 * (i + 1) * (i % 2 ? 1 : -1);
    const S state = plus(S(), begin);
    const double dt = 1e-3, times[] = {dt, dt * dt, dt, 1, 1, 1};
    const auto movedBy = [&](const S::Errors& errors, S::Matrix& change) {
        S at = plus(state, errors);
        advance(at, cv::Vec3d(1, -.5, .7), cv::Vec3d(3, -4, 8), dt, change);
        return at;
    };
    S::Matrix change, unused;
    const S after = movedBy(S::Errors(), change);
    cv::Mat_<double> analytic = cv::Mat_<double>(cv::Mat(change));
    for (int i = 0; i < S::SIZE; i++)
        analytic.row(i) /= times[i / 3];
    const auto errorsAt = [&](const Numbers& step) {
        const S::Errors errors = minus(movedBy(S::Errors(step.data()), unused), after);
        Numbers scaled;
        for (int i = 0; i < S::SIZE; i++)
            scaled.push_back(errors[i] / times[i / 3]);
        return scaled;
    };
    expectDerivatives(analytic, errorsAt, .01, .05);  // Affine3d::rvec is zero for rotations below 1e-5
}

// For an identity covariance the corner of the result is the derivative of the point by the rotation.
TEST(Smoothing, the_lever_arm_matches_finite_differences)
{
    const cv::Affine3d body(cv::Vec3d(.3, -.2, .5), cv::Vec3d(1, 2, 3));
    const cv::Vec3d lever(.4, -.3, .2);
    const cv::Mat atLever(covarianceAt(cv::Matx66d::eye(), body.rotation() * lever));
    const auto placeAt = [&](const Numbers& turn) {
        const cv::Vec3d at = cv::Affine3d(cv::Vec3d(turn.data())).rotation() * body.rotation() * lever;
        return Numbers{at[0], at[1], at[2]};
    };
    expectDerivatives(cv::Mat_<double>(atLever(cv::Rect(3, 0, 3, 3))), placeAt, 1e-6);
}

TEST(Smoothing, images_without_a_pose_get_one_and_others_a_better_one)
{
    Drive drive(14);
    EXPECT_LT(drive.meanError(drive.smoothed(readingsUntil(14))), 0.7 * drive.meanError(drive.images));
    drive.forgetMost();
    drive.images[1].reason = "too few matches";
    const std::vector<Location> found = drive.smoothed(readingsUntil(14));
    EXPECT_LT(drive.meanError(found), 0.03);
    EXPECT_EQ("", found[1].reason);
}

TEST(Smoothing, no_pose_long_after_the_last_image_nor_before_the_first)
{
    Drive drive(14);
    drive.forget(0, 1);
    drive.forget(12, drive.images.size());
    std::vector<ImuReading> readings = readingsUntil(14);
    std::vector<Location> found = drive.smoothed(readings);
    EXPECT_FALSE(found[0].found);
    EXPECT_LT(drive.errorOf(13, found[13]), 0.05);
    EXPECT_TRUE(found[17].found) << "three seconds after the last image";
    EXPECT_FALSE(found[18].found);
    readings.erase(readings.begin() + 1220, readings.begin() + 1260);  // 0.2 seconds, after 6.1
    found = drive.smoothed(readings);
    EXPECT_TRUE(found[12].found) << "at 6 seconds";
    EXPECT_FALSE(found[13].found) << "across a gap of the readings";
}

TEST(Smoothing, without_readings_the_images_poses_stay)
{
    Drive drive(4);
    drive.forget(3, 4);
    drive.expectUnchanged({}, "");
}

TEST(Smoothing, the_camera_is_away_from_the_imu)
{
    Drive drive(14, SECOND / 2, 1, cv::Affine3d(cv::Vec3d(1.2, -1.1, 1.3), cv::Vec3d(0.3, -0.2, 0.5)));
    drive.forgetMost();
    EXPECT_LT(drive.meanError(drive.smoothed(readingsUntil(14))), 0.03);
    drive.imuFromCamera = cv::Affine3d::Identity();
    drive.expectUnchanged(readingsUntil(14), CONTRADICTS);
}

TEST(Smoothing, a_wrong_pose_has_little_weight)
{
    Drive drive(14);
    drive.moveWrongly(12);
    EXPECT_GT(drive.errorOf(12, drive.images[12]), .7);
    EXPECT_LT(drive.errorOf(12, drive.smoothed(readingsUntil(14))[12]), 0.1);
}

TEST(Smoothing, readings_that_contradict_the_images_change_nothing)
{
    // The IMU's axes as a matrix, the factors of its units for rates and forces, and the delay of its clock.
    struct Mistake
    {
        const char* name;
        cv::Matx33d axes;
        double rate, force;
        int64 late;
    };
    const cv::Matx33d right = cv::Matx33d::eye();
    const Mistake mistakes[] = {{"force in g", right, 1, 1 / 9.81, 0},
            {"rate in degrees", right, 180 / CV_PI, 1, 0},
            {"y and z exchanged", {1, 0, 0, 0, 0, 1, 0, 1, 0}, 1, 1, 0},
            {"x and y exchanged", {0, 1, 0, 1, 0, 0, 0, 0, 1}, 1, 1, 0},
            {"axes in another order", {0, 1, 0, 0, 0, 1, 1, 0, 0}, 1, 1, 0},
            {"half a turn about x", cv::Matx33d::diag({1, -1, -1}), 1, 1, 0},
            {"half a turn about y", cv::Matx33d::diag({-1, 1, -1}), 1, 1, 0},
            {"force of the other sign", right, 1, -1, 0}, {"rate of the other sign", right, -1, 1, 0},
            {"half a second late", right, 1, 1, SECOND / 2}};
    Drive few(10), wide(7, SECOND / 4);
    few.forgetMost();
    for (Location& image : wide.images)
        image.covariance *= 4500;  // thirty times what it should be
    for (const Mistake& mistake : mistakes)
    {
        SCOPED_TRACE(mistake.name);
        std::vector<ImuReading> readings = readingsUntil(10);
        for (ImuReading& reading : readings)
            reading = {reading.nanoseconds + mistake.late, mistake.rate * (mistake.axes * reading.rate),
                    mistake.force * (mistake.axes * reading.force)};
        for (const Drive& drive : {Drive(7), few, wide})
            drive.expectUnchanged(readings, CONTRADICTS);
    }
}

// Images and their covariances are so uncertain that each innovation alone is plausible.
TEST(Smoothing, small_contradictions_in_all_images_change_nothing)
{
    Drive drive(10, SECOND / 4, 5);
    for (Location& image : drive.images)
        image.covariance *= 5;
    std::vector<ImuReading> readings = readingsUntil(11), late = readings;
    for (ImuReading& reading : late)
        reading.nanoseconds += SECOND / 2;
    late.erase(late.begin() + 2000, late.end());
    drive.smoothed(readings);
    drive.expectUnchanged(late, CONTRADICTS);
    drive.imuFromCamera = cv::Affine3d(cv::Vec3d(.42, .31, 0));  // rotated by 30 degrees
    drive.expectUnchanged(readings, CONTRADICTS);
}

TEST(Smoothing, covariances_of_images_without_a_pose_hold)
{
    int inside = 0, all = 0;
    double sum = 0;
    for (const double times : {1, 2, 4})
    {
        Drive drive(14, SECOND / 2, times);
        drive.forgetMost();
        const std::vector<ImuReading> readings = readingsUntil(14);
        std::vector<Location> found = drive.smoothed(readings);
        for (size_t i = 0; i < found.size(); i++)
        {
            if (drive.images[i].found)
            {
                EXPECT_EQ(drive.images[i].covariance, found[i].covariance) << i;
                continue;
            }
            const cv::Vec3d error = found[i].cameraFromWorld.inv().translation() -
                                    poseAt(double(drive.times[i]) * 1e-9).translation();
            const double squared = error.dot(found[i].covariance.get_minor<3, 3>(0, 0).inv() * error);
            inside += squared < 7.81;
            sum += squared / 3;
            all++;
        }
        EXPECT_EQ("", smoothPoses(drive.times, found, readings)) << "smoothed again";
    }
    EXPECT_GT(inside, .9 * all);
    EXPECT_GT(sum, .2 * all) << "covariances are not much too large";
}

// The result must not depend on where the camera is mounted on the IMU.
TEST(Smoothing, covariances_are_converted_between_camera_and_imu)
{
    const cv::Affine3d imuFromCamera(cv::Vec3d(.4, -.2, .3), cv::Vec3d(2, -1, 3));
    const auto lever = [&](const cv::Affine3d& imu) { return imu.rotation() * imuFromCamera.translation(); };
    Drive at(14);
    at.forgetMost();
    Drive beside = at;
    beside.imuFromCamera = imuFromCamera;
    for (Location& image : beside.images)
    {
        const cv::Affine3d imu = image.cameraFromWorld.inv();
        image.cameraFromWorld = (imu * imuFromCamera).inv();
        image.covariance = covarianceAt(image.covariance, lever(imu));
    }
    const std::vector<Location> found = at.smoothed(readingsUntil(14)),
                                moved = beside.smoothed(readingsUntil(14));
    for (size_t i = 0; i < found.size(); i++)
        if (!at.images[i].found)
        {
            const size_t last = i / 4 * 4;  // the last image with a pose
            const cv::Matx66d expected = beside.images[last].covariance +
                                         covarianceAt(found[i].covariance - at.images[last].covariance,
                                                 lever(found[i].cameraFromWorld.inv()));
            EXPECT_LT(cv::norm(expected, moved[i].covariance), 1e-6 * cv::norm(expected)) << i;
        }
}

TEST(Smoothing, invalid_covariances_change_nothing)
{
    for (const double value : {0., double(NAN), -1., HUGE_VAL})
    {
        Drive drive(4);
        drive.forget(2, 3);
        drive.images[3].covariance = cv::Matx66d::eye() * value;
        drive.expectUnchanged(readingsUntil(4),
                "image 3 has an invalid pose or covariance (not finite, or zero), so that it cannot be "
                "weighed against the readings: all poses stay as they are");
    }
}

TEST(Smoothing, readings_that_go_wrong_are_used_until_then)
{
    std::vector<ImuReading> readings = readingsUntil(20);
    for (ImuReading& reading : readings)
        if (reading.nanoseconds > int64(14.2e9))
            reading.rate *= -1;
    Drive drive(20);
    drive.forget(5, 6);
    drive.forget(31, 32);
    std::vector<Location> found = drive.images;
    const std::string reason = smoothPoses(drive.times, found, readings);
    int staying = 0;
    for (size_t i = 0; i < found.size(); i++)
    {
        staying += drive.images[i].found &&
                   found[i].cameraFromWorld.matrix == drive.images[i].cameraFromWorld.matrix;
        EXPECT_LT(drive.errorOf(i, found[i]), i == 31 ? 1001 : i == 5 ? .03 : .04) << i;
    }
    EXPECT_EQ(
            cv::format("the readings of the IMU contradict images: %d of 39 poses stay as they are", staying),
            reason);
    EXPECT_FALSE(found[31].found);
}

TEST(Smoothing, many_images_a_second_and_a_wrong_one_at_the_start)
{
    Drive drive(4, SECOND / 20);
    drive.moveWrongly(4);
    std::vector<Location> found = drive.images;
    EXPECT_NE(CONTRADICTS, smoothPoses(drive.times, found, readingsUntil(4)));
    EXPECT_LT(drive.errorOf(4, found[4]), 0.9);
    EXPECT_LT(drive.meanError(found, 5), .6 * drive.meanError(drive.images, 5));
}

TEST(Smoothing, refuses_unordered_times)
{
    Drive drive(2);
    std::vector<ImuReading> readings = readingsUntil(2);
    const auto error = [&] { return messageOf([&] { drive.smoothed(readings); }); };
    const std::string rise = ": times must be nanoseconds, of at most 19 digits, and rise";
    readings[3].force[1] = NAN;
    EXPECT_EQ("a reading of the IMU is not finite", error());
    readings = readingsUntil(2);
    for (const double turn : {double(NAN), 2.})
    {
        drive.imuFromCamera = cv::Affine3d(cv::Matx33d::eye() * turn, cv::Vec3d());
        EXPECT_EQ("imuFromCamera must be a finite rotation and translation", error());
    }
    drive.imuFromCamera = cv::Affine3d::Identity();
    readings[3] = readings[2];
    EXPECT_EQ("reading 3 has the time 10000000" + rise, error());
    for (const int64 time : {int64(5e18), std::numeric_limits<int64>::min()})
    {
        drive.times[1] = time;
        EXPECT_EQ("image 1 has the time " + std::to_string(time) + rise, error());
    }
    drive.times.pop_back();
    EXPECT_EQ("there are 4 times of 5 images", error());
}

}}  // namespace opencv_test
