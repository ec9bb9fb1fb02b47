// SPDX-License-Identifier: Apache-2.0

#include <random>

#include "iib_geometry/test/test_folder.hpp"
#include "smoother.hpp"
#include "trajectory.hpp"

namespace {
using namespace iib_localization;

const cv::Vec3d GRAVITY(0, 9.81 * 0.8, 9.81 * 0.6);  // no axis of the world
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
    for (int64_t time = 0; time <= int64_t(seconds * 1e9); time += 5000000)
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

//! Frames half a second apart with poses about a centimetre and a tenth of a degree off.
std::vector<VisualFrame> framesUntil(
        double seconds, const cv::Affine3d& imuFromCamera = cv::Affine3d::Identity())
{
    std::mt19937 random(1);
    std::normal_distribution<double> metres(0, 0.006), radians(0, 0.0015);
    std::vector<VisualFrame> frames;
    for (int64_t time = 0; time <= int64_t(seconds * 1e9); time += 500000000)
    {
        const cv::Affine3d truth = poseAt(double(time) * 1e-9) * imuFromCamera;
        const cv::Vec3d moved(metres(random), metres(random), metres(random));
        const cv::Vec3d turned(radians(random), radians(random), radians(random));
        cv::Matx66d covariance;
        for (int i = 0; i < 6; i++)  // points of the map err together: told as less than it is
            covariance(i, i) = (i < 3 ? 0.006 * 0.006 : 0.0015 * 0.0015) / 5;
        frames.push_back({time,
                cv::Affine3d(cv::Affine3d(turned).rotation() * truth.rotation(), truth.translation() + moved),
                covariance});
    }
    return frames;
}

//! In metres.
double errorOf(const VisualFrame& frame, const std::optional<cv::Affine3d>& pose)
{
    return pose ? cv::norm(pose->translation() - poseAt(double(frame.nanoseconds) * 1e-9).translation())
                : 1e9;
}

TEST(Smoother, frames_without_a_pose_get_one)
{
    const std::vector<ImuReading> readings = readingsUntil(14);
    std::vector<VisualFrame> frames = framesUntil(14);
    for (size_t i = 0; i < frames.size(); i++)
        if (i % 4 != 0)
            frames[i].pose.reset();
    const std::vector<std::optional<cv::Affine3d>> poses = smooth(frames, readings, cv::Affine3d::Identity());
    double sum = 0;
    for (size_t i = 0; i < frames.size(); i++)
        sum += errorOf(frames[i], poses[i]);
    EXPECT_LT(sum / double(frames.size()), 0.03);
}

TEST(Smoother, images_and_imu_are_better_than_images)
{
    const std::vector<VisualFrame> frames = framesUntil(14);
    const std::vector<std::optional<cv::Affine3d>> poses =
            smooth(frames, readingsUntil(14), cv::Affine3d::Identity());
    double alone = 0, together = 0;
    for (size_t i = 0; i < frames.size(); i++)
    {
        alone += errorOf(frames[i], frames[i].pose);
        together += errorOf(frames[i], poses[i]);
    }
    EXPECT_LT(together, 0.7 * alone);
}

TEST(Smoother, no_pose_long_after_the_last_image_nor_before_the_first)
{
    std::vector<VisualFrame> frames = framesUntil(14);
    frames[0].pose.reset();
    for (size_t i = 12; i < frames.size(); i++)
        frames[i].pose.reset();
    const std::vector<std::optional<cv::Affine3d>> poses =
            smooth(frames, readingsUntil(14), cv::Affine3d::Identity());
    EXPECT_FALSE(poses[0]);
    EXPECT_LT(errorOf(frames[13], poses[13]), 0.05);
    EXPECT_TRUE(poses[17]) << "three seconds after the last image";
    EXPECT_FALSE(poses[18]);
}

TEST(Smoother, no_pose_across_a_gap_of_the_readings)
{
    std::vector<ImuReading> readings = readingsUntil(14);
    readings.erase(readings.begin() + 1220, readings.begin() + 1260);  // 0.2 seconds, after 6.1
    std::vector<VisualFrame> frames = framesUntil(14);
    for (size_t i = 12; i < frames.size(); i++)
        frames[i].pose.reset();
    const std::vector<std::optional<cv::Affine3d>> poses = smooth(frames, readings, cv::Affine3d::Identity());
    EXPECT_TRUE(poses[12]) << "at 6 seconds";
    EXPECT_FALSE(poses[13]);
}

TEST(Smoother, without_readings_the_images_poses_stay)
{
    std::vector<VisualFrame> frames = framesUntil(4);
    frames[3].pose.reset();
    const std::vector<std::optional<cv::Affine3d>> poses = smooth(frames, {}, cv::Affine3d::Identity());
    for (size_t i = 0; i < frames.size(); i++)
        EXPECT_EQ(i == 3 ? 1e9 : errorOf(frames[i], frames[i].pose), errorOf(frames[i], poses[i]));
}

TEST(Smoother, the_camera_is_elsewhere_on_the_imu)
{
    const cv::Affine3d imuFromCamera(cv::Vec3d(1.2, -1.1, 1.3), cv::Vec3d(0.3, -0.2, 0.5));
    std::vector<VisualFrame> frames = framesUntil(14, imuFromCamera);
    for (size_t i = 0; i < frames.size(); i++)
        if (i % 4 != 0)
            frames[i].pose.reset();
    const auto mean = [&](const cv::Affine3d& told) {
        const std::vector<std::optional<cv::Affine3d>> poses = smooth(frames, readingsUntil(14), told);
        double sum = 0;
        for (size_t i = 0; i < frames.size(); i++)
            sum += errorOf(frames[i],
                    poses[i] ? std::optional<cv::Affine3d>(*poses[i] * imuFromCamera.inv()) : poses[i]);
        return sum / double(frames.size());
    };
    EXPECT_LT(mean(imuFromCamera), 0.03);
    EXPECT_GT(mean(cv::Affine3d::Identity()), 0.1);
}

TEST(Smoother, a_wrong_pose_counts_little)
{
    std::vector<VisualFrame> frames = framesUntil(14);
    frames[12].pose->matrix(0, 3) += 0.8;
    const std::vector<std::optional<cv::Affine3d>> poses =
            smooth(frames, readingsUntil(14), cv::Affine3d::Identity());
    EXPECT_LT(errorOf(frames[12], poses[12]), 0.1);
}

TEST(Imu, reads_euroc)
{
    const TestFolder folder;
    const std::string path = folder.path("imu.csv");
    folder.write("imu.csv", "#timestamp [ns],w_x\n0,0.1,-0.2,0.3,1,2,9.81\r\n5000000,0,0,0,1e-3,0,0\n");
    const std::vector<ImuReading> readings = readImu(path);
    ASSERT_EQ(2u, readings.size());
    EXPECT_EQ(5000000, readings[1].nanoseconds);
    EXPECT_EQ(cv::Vec3d(0.1, -0.2, 0.3), readings[0].rate);
    EXPECT_EQ(cv::Vec3d(1, 2, 9.81), readings[0].force);
    for (const char* wrong : {"5,0,0,,0,0,0", "5,0,0,0,0,0", "5,0,0,0,0,0,0,0", "x,0,0,0,0,0,0", ""})
    {
        folder.write("imu.csv", std::string("# of an IMU\n") + wrong + "\n");
        EXPECT_EQ(*wrong ? path + ":2: not a time and six numbers" : path + " has no readings",
                messageOf([&] { readImu(path); }))
                << wrong;
    }
    for (const char* time : {"9.3e18", "-9.3e18", "1e300"})
    {
        folder.write("imu.csv", std::string(time) + ",0,0,0,0,0,0\n");
        EXPECT_EQ(path + ":1: the time is not in nanoseconds", messageOf([&] { readImu(path); })) << time;
    }
    folder.write("imu.csv", "5,0,0,0,0,0,0\n5,0,0,0,0,0,0\n");
    EXPECT_EQ(path + ":2: the time does not rise", messageOf([&] { readImu(path); }));
}

TEST(Imu, names_that_are_times)
{
    EXPECT_EQ(1500000000, *nanoseconds("01.500000"));
    EXPECT_EQ(1403636579763555584, *nanoseconds("1403636579763555584"));
    EXPECT_EQ(1403636579763555584, *nanoseconds("1403636579.763555584"));
    EXPECT_EQ(3000000000, *nanoseconds("0003"));
    EXPECT_FALSE(nanoseconds("left_0003"));
    // differences would overflow; milliseconds
    for (const char* other : {"9999999999999999999", "9223372036854775807", "1403636579763", "99999999999"})
        EXPECT_FALSE(nanoseconds(other));
    EXPECT_FALSE(nanoseconds(""));
}

}  // namespace
