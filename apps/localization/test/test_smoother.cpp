// SPDX-License-Identifier: Apache-2.0

#include <random>

#include "../src/smoother.hpp"
#include "opencv2/ts.hpp"

namespace {
using namespace iib_localization;

const Pinhole CAMERA = {500, 500, 320, 240};
const Eigen::Vector3d GRAVITY(0, 9.81 * 0.8, 9.81 * 0.6);  // no axis of the world

//! A smooth path, as a function of seconds.
Pose poseAt(double t)
{
    const Eigen::Quaterniond turn = Eigen::AngleAxisd(0.3 * std::sin(0.9 * t), Eigen::Vector3d::UnitY()) *
                                    Eigen::AngleAxisd(0.1 * std::sin(1.7 * t), Eigen::Vector3d::UnitX());
    return {turn, {0.5 * std::sin(0.8 * t), 0.1 * std::sin(2 * t), 1.2 * t + 0.2 * std::sin(t)}};
}

std::vector<ImuReading> readingsUntil(double seconds, const ImuBias& bias)
{
    std::vector<ImuReading> readings;
    const double h = 1e-4;
    for (int64_t time = 0; time <= int64_t(seconds * 1e9); time += 5000000)
    {
        const double t = double(time) * 1e-9;
        const Pose before = poseAt(t - h), now = poseAt(t), after = poseAt(t + h);
        const Eigen::AngleAxisd turn(before.rotation.conjugate() * after.rotation);
        const Eigen::Vector3d acceleration = (before.position - 2 * now.position + after.position) / (h * h);
        readings.push_back({time, turn.axis() * turn.angle() / (2 * h) + bias.rate,
                now.rotation.conjugate() * (acceleration - GRAVITY) + bias.force});
    }
    return readings;
}

//! Frames half a second apart with poses a centimetre off and forty points seen with an error of a pixel.
std::vector<VisualFrame> framesUntil(double seconds)
{
    std::mt19937 random(1);
    std::normal_distribution<double> normal;
    std::uniform_real_distribution<double> unit(0, 1);
    std::vector<VisualFrame> frames;
    for (int64_t time = 0; time <= int64_t(seconds * 1e9); time += 500000000)
    {
        const Pose truth = poseAt(double(time) * 1e-9);
        VisualFrame frame = {time, truth};
        frame.pose->position += Eigen::Vector3d(normal(random), normal(random), normal(random)) * 0.006;
        for (int i = 0; i < 40; i++)
        {
            const Eigen::Vector2d pixel(640 * unit(random), 480 * unit(random));
            const Eigen::Vector3d point = truth.toWorld(CAMERA.ray(pixel) * (4 + 10 * unit(random)));
            frame.inliers.push_back({point, pixel + Eigen::Vector2d(normal(random), normal(random))});
        }
        frames.push_back(frame);
    }
    return frames;
}

double errorOf(const VisualFrame& frame, const std::optional<Pose>& pose)
{
    return pose ? (pose->position - poseAt(double(frame.nanoseconds) * 1e-9).position).norm() : 1e9;
}

void hide(VisualFrame& frame)
{
    frame.pose.reset();
    frame.inliers.clear();
}

const ImuBias BIAS = {{0.003, -0.002, 0.004}, {0.03, -0.02, 0.04}};

TEST(Preintegration, follows_a_path)
{
    const std::vector<ImuReading> readings = readingsUntil(3, BIAS);
    Preintegration p;
    // neither time is that of a reading
    const int64_t from = 1002345678, to = 2498765432;
    ASSERT_TRUE(preintegrate(readings, from, to, BIAS, p));
    const Pose a = poseAt(from * 1e-9), b = poseAt(to * 1e-9);
    const Eigen::Vector3d velocity =
            (poseAt(from * 1e-9 + 1e-5).position - poseAt(from * 1e-9 - 1e-5).position) / 2e-5;
    EXPECT_NEAR((to - from) * 1e-9, p.seconds, 1e-9);
    EXPECT_LT((a.rotation * p.rotation).angularDistance(b.rotation), 1e-4);
    const Eigen::Vector3d end =
            a.position + velocity * p.seconds + GRAVITY * p.seconds * p.seconds / 2 + a.rotation * p.position;
    EXPECT_LT((end - b.position).norm(), 1e-3);
    EXPECT_FALSE(preintegrate(readings, from, 3100000000, BIAS, p)) << "beyond the last reading";
    std::vector<ImuReading> gap = readings;
    gap.erase(gap.begin() + 300, gap.begin() + 330);
    EXPECT_FALSE(preintegrate(gap, from, to, BIAS, p));
}

TEST(Smoother, frames_without_a_pose_get_one)
{
    const std::vector<ImuReading> readings = readingsUntil(14, BIAS);
    std::vector<VisualFrame> frames = framesUntil(14);
    for (size_t i = 0; i < frames.size(); i++)
        if (i % 4 != 0)
            hide(frames[i]);
    const std::vector<std::optional<Pose>> poses = smooth(CAMERA, frames, readings);
    double sum = 0;
    for (size_t i = 0; i < frames.size(); i++)
        sum += errorOf(frames[i], poses[i]);
    EXPECT_LT(sum / double(frames.size()), 0.03);
}

TEST(Smoother, images_and_imu_are_better_than_images)
{
    const std::vector<VisualFrame> frames = framesUntil(14);
    const std::vector<std::optional<Pose>> poses = smooth(CAMERA, frames, readingsUntil(14, BIAS));
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
    hide(frames[0]);
    for (size_t i = 12; i < frames.size(); i++)
        hide(frames[i]);
    const std::vector<std::optional<Pose>> poses = smooth(CAMERA, frames, readingsUntil(14, BIAS));
    EXPECT_FALSE(poses[0]);
    EXPECT_LT(errorOf(frames[13], poses[13]), 0.05);
    EXPECT_TRUE(poses[17]) << "three seconds after the last image";
    EXPECT_FALSE(poses[18]);
}

TEST(Smoother, without_readings_the_images_poses_stay)
{
    std::vector<VisualFrame> frames = framesUntil(4);
    hide(frames[3]);
    const std::vector<std::optional<Pose>> poses = smooth(CAMERA, frames, {});
    for (size_t i = 0; i < frames.size(); i++)
        EXPECT_EQ(i == 3 ? 1e9 : errorOf(frames[i], frames[i].pose), errorOf(frames[i], poses[i]));
}

}  // namespace
