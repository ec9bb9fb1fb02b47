// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "../src/localizer.hpp"
#include "../src/map_builder.hpp"
#include "../src/trajectory.hpp"
#include "common/test/test_folder.hpp"
#include "opencv2/imgcodecs.hpp"
#include "opencv2/imgproc.hpp"

namespace iib_localization {

inline const cv::Size SIZE(320, 240);
inline const Camera CAMERA = {"PINHOLE", SIZE, {260, 260, 160, 120}};

/** A textured wall that a camera in any pose near the origin sees, 4 m away and slanted:
points (x, y, 4 + 0.4 x) for each pixel (120 a metre) of the texture. */
class Wall
{
public:
    explicit Wall(uint64 seed) : texture_(900, 1200, CV_32F, cv::Scalar(128))
    {
        cv::RNG random(seed);
        for (int cell : {3, 9, 27, 81})
        {
            cv::Mat noise(texture_.rows / cell + 2, texture_.cols / cell + 2, CV_32F), large;
            random.fill(noise, cv::RNG::NORMAL, 0, 30);
            cv::resize(noise, large, texture_.size(), 0, 0, cv::INTER_CUBIC);
            texture_ += large;
        }
        texture_.convertTo(texture_, CV_8U);
    }

    explicit Wall(const cv::Mat& texture) : texture_(texture) {}

    cv::Mat image(const Pose& pose) const
    {
        cv::Mat result;
        cv::warpPerspective(texture_, result, textureToImage(pose), SIZE, cv::INTER_AREA);
        return result;
    }

    //! In millimetres.
    static cv::Mat depth(const Pose& pose)
    {
        cv::Mat result(SIZE, CV_16U);
        // the wall is n x = 4
        const Eigen::Vector3d n(-0.4, 0, 1);
        for (int y = 0; y < SIZE.height; y++)
            for (int x = 0; x < SIZE.width; x++)
            {
                const Eigen::Vector3d ray = CAMERA.pinhole().ray({x, y});
                const double z = (4 - n.dot(pose.position)) / n.dot(pose.rotation * ray);
                result.at<ushort>(y, x) = cv::saturate_cast<ushort>(z * 1000);
            }
        return result;
    }

private:
    static cv::Mat textureToImage(const Pose& pose)
    {
        const Pinhole p = CAMERA.pinhole();
        Eigen::Matrix3d k, wall;
        k << p.fx, 0, p.cx, 0, p.fy, p.cy, 0, 0, 1;
        // texture (u, v, 1) to the world
        wall << 1 / 120., 0, -5, 0, 1 / 120., -3.75, 0.4 / 120, 0, 4 - 0.4 * 5;
        wall.col(2) -= pose.position;
        const Eigen::Matrix3d h = k * pose.rotation.conjugate().toRotationMatrix() * wall;
        cv::Mat result(3, 3, CV_64F);
        for (int i = 0; i < 9; i++)
            result.at<double>(i / 3, i % 3) = h(i / 3, i % 3);
        return result;
    }

    cv::Mat texture_;
};

inline Pose poseAt(double x, double y, double yaw)
{
    return {Eigen::Quaterniond(Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitY())), {x, y, 0.2 * x}};
}

//! Six keyframes along the wall.
class Localization : public testing::Test
{
protected:
    explicit Localization(const Wall& pictured = Wall(1)) : wall(pictured)
    {
        folder.makeFolder("images");
        folder.makeFolder("depth");
        std::vector<NamedPose> poses;
        for (int i = 0; i < 6; i++)
        {
            const NamedPose p = {"k" + std::to_string(i), poseAt(0.3 * i - 0.8, 0.05 * (i % 2), 0.03 * i)};
            cv::imwrite(folder.path("images/" + p.name + ".png"), wall.image(p.pose));
            cv::imwrite(folder.path("depth/" + p.name + ".png"), Wall::depth(p.pose));
            poses.push_back(p);
        }
        writeCameras(folder.path("cameras.txt"), {{1, CAMERA}});
        writeTrajectory(folder.path("poses.txt"), poses);
        sources.images = folder.path("images");
        sources.cameras = folder.path("cameras.txt");
        sources.poses = folder.path("poses.txt");
    }

    void expectFound(const Map& map, const cv::Mat& image, const Pose& truth, double metres)
    {
        const Location location = Localizer(map, CAMERA).locate(image);
        ASSERT_TRUE(location.found) << location.reason;
        EXPECT_LT((location.estimate.pose.position - truth.position).norm(), metres);
        EXPECT_LT(location.metres, 0.05);
        EXPECT_LT(location.estimate.pose.rotation.angularDistance(truth.rotation), 0.5 * CV_PI / 180);
    }

    const TestFolder folder;
    const Wall wall;
    MapSources sources;
};

}  // namespace iib_localization
