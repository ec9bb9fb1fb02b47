// SPDX-License-Identifier: Apache-2.0

#include <random>

#include "../src/focal_check.hpp"
#include "../src/pnp.hpp"
#include "opencv2/ts.hpp"

namespace {
using namespace iib_localization;

const Pinhole TRUTH = {500, 500, 319.5, 239.5};

/** Five images of a true camera, localized with another one: a third of their matches are wrong, the others have noise of
half a pixel. */
FocalCheck imagesFor(const Pinhole& told)
{
    std::mt19937 random(1);
    std::uniform_real_distribution<double> unit(0, 1);
    std::normal_distribution<double> noise(0, 0.5);
    FocalCheck check(told);
    for (int image = 0; image < 5; image++)
    {
        const Pose pose = {Eigen::Quaterniond(Eigen::AngleAxisd(0.2 * image, Eigen::Vector3d::UnitY())),
                {0.5 * image, 0, 1}};
        Location location;
        for (int i = 0; i < 150; i++)
        {
            const Eigen::Vector2d pixel(640 * unit(random), 480 * unit(random));
            const Eigen::Vector3d point = pose.toWorld(TRUTH.ray(pixel) * (3 + 20 * unit(random)));
            const Eigen::Vector2d wrong(640 * unit(random), 480 * unit(random));
            location.matched.push_back(
                    {point, i % 3 == 0 ? wrong : pixel + Eigen::Vector2d(noise(random), noise(random))});
        }
        location.found = poseByRansac(location.matched, told, location.estimate.pose) &&
                         agreeing(location.matched, told, location.estimate.pose).size() > 30;
        check.add(location);
    }
    return check;
}

TEST(FocalCheck, says_nothing_of_a_right_camera)
{
    EXPECT_EQ(1, imagesFor(TRUTH).scale());
    EXPECT_EQ(1, imagesFor({505, 505, 319.5, 239.5}).scale()) << "one per cent is too little to tell";
    EXPECT_EQ(1, FocalCheck(TRUTH).scale()) << "without images";
}

TEST(FocalCheck, finds_the_focal_length_also_if_no_image_has_a_pose)
{
    for (double wrong : {0.6, 0.9, 1.04})
        EXPECT_NEAR(1 / wrong, imagesFor({500 * wrong, 500 * wrong, 319.5, 239.5}).scale(), 0.005 / wrong);
}

TEST(FocalCheck, says_nothing_where_nothing_agrees)
{
    std::mt19937 random(1);
    std::uniform_real_distribution<double> unit(-1, 1);
    FocalCheck check(TRUTH);
    for (int image = 0; image < 2; image++)
    {
        Location location;
        for (int i = 0; i < 100; i++)
            location.matched.push_back({{10 * unit(random), 10 * unit(random), 15 + 10 * unit(random)},
                    {320 + 320 * unit(random), 240 + 240 * unit(random)}});
        check.add(location);
    }
    EXPECT_EQ(1, check.scale());
}

}  // namespace
