// SPDX-License-Identifier: Apache-2.0

#include "pose/camera_pose.hpp"
#include "map/triangulation.hpp"
#include "../test_precomp.hpp"

namespace opencv_test { namespace {
using namespace cv::iib;

const Camera VGA = {"PINHOLE", {640, 480}, {500, 500, 320, 240}};

Vec3d anyVector(RNG& random, double deviation)
{
    return {random.gaussian(deviation), random.gaussian(deviation), random.gaussian(deviation)};
}

Affine3d anyMotion(RNG& random, double turn, double way)
{
    const Vec3d moved = anyVector(random, way), turned = anyVector(random, turn);
    return {turned, moved};
}

//! Images of one place with exact pixels, whose poses have errors of size `far`, and of a third of it in radians.
struct WrongMap
{
    Map map;
    std::vector<Point3d> points;

    WrongMap(RNG& random, int images, double far)
    {
        for (int i = 0; i < 60; i++)
        {
            const double z = random.uniform(4., 8.), y = random.uniform(-1.5, 1.5),
                         x = random.uniform(-2., 2.);
            points.emplace_back(x, y, z);
        }
        map.points = points;
        for (int i = 0; i < images; i++)
        {
            MapImage image;
            image.camera = VGA;
            const Affine3d truth = anyMotion(random, .03, .6);
            image.pixels = VGA.project(inCamera(points, truth));
            for (int k = 0; k < int(points.size()); k++)
                image.sees.push_back(k);
            const Affine3d wrong = anyMotion(random, far / 3, far);
            image.cameraFromWorld = wrong * truth;
            map.images.push_back(image);
        }
    }

    //! Matches with the points as the map triangulates them.
    std::vector<Match> matches(const Affine3d& truth) const
    {
        std::vector<Track> tracks(points.size());
        for (size_t i = 0; i < map.images.size(); i++)
            for (const Ray& ray : raysOf(i, map.images[i]))
                tracks[size_t(ray.point)].push_back(ray);
        const std::vector<Point2d> pixels = VGA.project(inCamera(points, truth));
        std::vector<Match> found;
        for (size_t k = 0; k < tracks.size(); k++)
        {
            Match match{pixels[k], {}};
            if (triangulatePoint(tracks[k], match.point))
                found.push_back(match);
        }
        return found;
    }
};

// Without the isotropic part the covariance has no full rank: 54, 71 and 90 % are inside the 95 % limit.
TEST(MapError, of_few_images_predicts_errors_of_poses)
{
    RNG random(4);
    const int trials = 100;
    const double level50 = 2.366, level95 = 7.815;  // chi^2 with three degrees of freedom
    for (int images : {3, 4, 6})
    {
        int inside50 = 0, inside95 = 0;
        double share = 0;  // of the squared error in the reported variance
        for (int trial = 0; trial < trials; trial++)
        {
            const WrongMap scene(random, images, .003);
            const Affine3d truth = anyMotion(random, .03, .6);
            const std::vector<Match> matches = scene.matches(truth);
            Affine3d pose = truth;
            Matx66d covariance;
            ASSERT_TRUE(refinePose(matches, Lens(VGA), pose, covariance));
            const Matx66d error = inWorld(mapError(scene.map), pose, medianDistance(inCamera(matches, pose)));
            const Matx33d reported = error.get_minor<3, 3>(0, 0);
            const Vec3d moved = inverse(truth).translation() - inverse(pose).translation();
            const double squared = moved.dot(reported.inv(DECOMP_SVD) * moved);
            inside50 += squared < level50;
            inside95 += squared < level95;
            share += moved.dot(moved) / trace(reported) / trials;
        }
        EXPECT_GT(inside50, 45) << images;
        EXPECT_GT(inside95, 90) << images;
        EXPECT_GT(share, .2) << images;
    }
}

TEST(MapError, of_an_exact_map_is_zero)
{
    RNG random(4);
    const Matx66d none = mapError(WrongMap(random, 5, 0).map);
    EXPECT_LT(cv::norm(none, NORM_INF), 1e-12);
    EXPECT_EQ(Matx66d::zeros(), mapError(WrongMap(random, 2, .01).map)) << "two images determine no error";
}

}}  // namespace opencv_test
