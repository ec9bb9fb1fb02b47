// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>

#include "test_folder.hpp"
#include "pose/lens.hpp"
#include "map/map_folder.hpp"
#include "opencv2/core/quaternion.hpp"
#include "opencv2/iib.hpp"
#include "opencv2/imgcodecs.hpp"
#include "opencv2/imgproc.hpp"
#include "pose/camera_pose.hpp"

namespace opencv_test {
using namespace cv::iib;

inline const cv::Size SIZE(320, 240);
inline const Camera CAMERA = {"PINHOLE", SIZE, {260, 260, 160, 120}};

inline std::string textOf(const std::string& path)
{
    std::ifstream stream(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
}

//! World from camera; yaw is to the right.
inline cv::Affine3d poseAt(double x, double y, double yaw)
{
    return cv::Affine3d(cv::Vec3d(0, yaw, 0), cv::Vec3d(x, y, 0.2 * x));
}

inline const cv::Affine3d TRUTH = poseAt(0.1, -0.1, 0.1);

//! Poses along the wall, of which a map has the first six.
inline cv::Affine3d pathPose(int i) { return poseAt(0.3 * i - 0.8, 0.05 * (i % 2), 0.03 * i); }

//! Names of images along the wall, three of them in a subfolder.
inline std::string pathName(int i) { return (i < 3 ? "left side/" : "") + std::to_string(i) + ".png"; }

inline cv::Vec3d centre(const Location& location) { return inverse(location.cameraFromWorld).translation(); }

//! Expects a pose whose position is that near to the true one, and whose rotation is within half a degree.
inline void expectAt(const cv::Affine3d& truth, const Location& location, double metres)
{
    ASSERT_TRUE(location.found) << location.reason;
    EXPECT_EQ("", location.reason);
    EXPECT_LT(cv::norm(centre(location) - truth.translation()), metres);
    EXPECT_LT(cv::norm((truth * location.cameraFromWorld).rvec()), 0.5 * CV_PI / 180);
    EXPECT_GE(int(location.pixels.size()), location.inliers);
    EXPECT_EQ(location.pixels.size(), location.points.size());
    EXPECT_GE(location.matches, location.inliers);
}

/** A slanted, textured wall 4 m from the origin: points (x, y, 4 + 0.4 x), with 120 pixels of texture a metre. */
class Wall
{
public:
    //! @param posters number of uniform rectangles, which have straight edges.
    explicit Wall(uint64 seed, int posters = 0) : texture_(900, 1200, CV_32F, cv::Scalar(128))
    {
        cv::RNG random(seed);
        for (int cell : {3, 9, 27, 81})
        {
            cv::Mat noise(texture_.rows / cell + 2, texture_.cols / cell + 2, CV_32F), large;
            random.fill(noise, cv::RNG::NORMAL, 0, 30);
            cv::resize(noise, large, texture_.size(), 0, 0, cv::INTER_CUBIC);
            texture_ += large;
        }
        for (int i = 0; i < posters; i++)
        {
            const int y = random.uniform(0, texture_.rows - 200), x = random.uniform(0, texture_.cols - 200),
                      grey = random.uniform(0, 256), height = random.uniform(60, 200),
                      width = random.uniform(60, 200);
            cv::rectangle(texture_, cv::Rect(x, y, width, height), cv::Scalar(grey), cv::FILLED);
        }
        texture_.convertTo(texture_, CV_8U);
    }

    cv::Mat image(const cv::Affine3d& worldFromCamera) const
    {
        cv::Matx33d wall(1 / 120., 0, -5, 0, 1 / 120., -3.75, 0.4 / 120, 0, 4 - 0.4 * 5);  // texture to world
        for (int i = 0; i < 3; i++)
            wall(i, 2) -= worldFromCamera.translation()[i];
        cv::Mat result;
        cv::warpPerspective(texture_, result, Lens(CAMERA).matrix() * worldFromCamera.rotation().t() * wall,
                SIZE, cv::INTER_AREA);
        return result;
    }

    //! The point of the wall that a camera sees at a pixel.
    static cv::Point3d point(const cv::Affine3d& worldFromCamera, const cv::Point2f& pixel)
    {
        const cv::Vec3d normal(-0.4, 0, 1);  // the wall is normal * x = 4
        const cv::Vec3d ray =
                worldFromCamera.rotation() * Lens(CAMERA).matrix().inv() * cv::Vec3d(pixel.x, pixel.y, 1);
        const cv::Vec3d centre = worldFromCamera.translation();
        return centre + ray * ((4 - normal.dot(centre)) / normal.dot(ray));
    }

private:
    cv::Mat texture_;
};

template <typename T> void put(std::string& file, T value)
{
    file.append(reinterpret_cast<const char*>(&value), sizeof(value));
}

//! Contents of files by name.
typedef std::map<std::string, std::string> Files;

//! Six images along a wall, three of them in a subfolder, and their map with exact points.
struct WallScene
{
    WallScene() : wall(1)
    {
        map.keypoints = 1000;
        const auto iib = IIB::createRecommended(map.keypoints);
        for (int i = 0; i < 6; i++)
        {
            const cv::Affine3d pose = pathPose(i);
            const cv::Mat picture = wall.image(pose);
            MapImage image;
            image.name = pathName(i);
            image.camera = CAMERA;
            image.cameraFromWorld = inverse(pose);
            std::vector<cv::KeyPoint> keypoints;
            iib->detectAndCompute(picture, cv::noArray(), keypoints, image.codes);
            for (const cv::KeyPoint& k : keypoints)
            {
                image.sees.push_back(int(map.points.size()));
                image.pixels.emplace_back(k.pt);
                image.sizes.push_back(k.size);
                map.points.push_back(Wall::point(pose, k.pt));
            }
            image.misses.assign(keypoints.size(), 0);
            image.picture = pictureOf(picture);
            map.images.push_back(image);
            pictures.push_back(picture);
        }
    }

    const Wall wall;
    Map map;
    std::vector<cv::Mat> pictures;
};

//! Shares one scene among all tests, and writes its images and map to a folder for each test.
class WallTest : public testing::Test
{
protected:
    WallTest() : wall(scene().wall), map(scene().map)
    {
        folder.makeFolder("images/left side");
        for (size_t i = 0; i < map.images.size(); i++)
        {
            cv::imwrite(folder.path("images/" + map.images[i].name), scene().pictures[i]);
            map.images[i].codes = map.images[i].codes.clone();  // tests may change their codes
        }
        MapFolder(folder.path("map")).write(map);
    }

    static const WallScene& scene()
    {
        static const WallScene made;
        return made;
    }

    //! Reads images below a folder.
    ImageReader images(const std::string& below = "images") const
    {
        return [this, below](const std::string& name) {
            const std::string path = folder.path(below + "/" + name);
            return cv::utils::fs::exists(path) ? cv::imread(path, cv::IMREAD_GRAYSCALE) : cv::Mat();
        };
    }

    /** A binary COLMAP model of the six images and one missing image.
    @param points number of points, each seen by all images.
    @param camera COLMAP's number of the camera model; 1 is PINHOLE. */
    Files model(double unit, int points, uint32_t camera = 1, const cv::Vec3d& origin = cv::Vec3d()) const
    {
        Files files;
        std::string &cameras = files["cameras.bin"], &posed = files["images.bin"];
        put<uint64_t>(cameras, 1);
        for (uint32_t number : {5u, camera})
            put(cameras, number);
        for (int side : {SIZE.width, SIZE.height})
            put<uint64_t>(cameras, uint64_t(side));
        for (double parameter : CAMERA.parameters)
            put(cameras, parameter);
        put<uint64_t>(posed, 7);
        for (int i = 0; i < 7; i++)
        {
            const cv::Affine3d world = pathPose(i);
            const cv::Matx33d rotation = world.rotation().t();
            put(posed, uint32_t(10 + i));
            put(posed, cv::Quatd::createFromRotMat(rotation).toVec());
            put(posed, cv::Vec3d(-(rotation * (world.translation() * unit + origin))));
            put<uint32_t>(posed, 5);
            posed += pathName(i) + '\0';
            put<uint64_t>(posed, uint64_t(points));
            for (int64_t point = 0; point < points; point++)
            {
                put(posed, cv::Vec2d(7, 8));
                put(posed, 100 + point);
            }
        }
        return files;
    }

    void write(const Files& files) const
    {
        folder.makeFolder("sparse 0");
        for (const auto& [name, content] : files)
            folder.write("sparse 0/" + name, content);
    }

    const TestFolder folder;
    const Wall& wall;
    Map map;
};

}  // namespace opencv_test
