// SPDX-License-Identifier: Apache-2.0

#include "wall.hpp"

namespace {
using namespace iib_localization;
using cv::iib::Localizer;
using cv::iib::Location;

constexpr uint32_t FOV = 7;  // COLMAP's number

class Mapping : public WallTest
{
protected:
    std::string error(const Files& files, const std::string& photographs = "images") const
    {
        write(files);
        return messageOf([&] { Localizer(folder.path("sparse 0"), folder.path(photographs)); });
    }
};

TEST_F(Mapping, images_are_found_in_a_model)
{
    const cv::Affine3d truth = poseAt(0.1, -0.1, 0.1);
    const cv::Mat image = wall.image(truth);
    for (double unit : {1., 250.})
        for (int points : {0, 40})
        {
            SCOPED_TRACE(cv::format("unit %g, %d points", unit, points));
            write(model(unit, points));
            size_t last = 0, all = 0;
            std::string told;
            const Localizer localizer(folder.path("sparse 0"), folder.path("images"), 1000,
                    [&](size_t done, size_t of, const std::string& problem) {
                        EXPECT_LE(last, done);
                        last = done;
                        all = of;
                        told += problem;
                    });
            EXPECT_EQ(7u + 21u, all);
            EXPECT_EQ(all, last);
            EXPECT_EQ(folder.path("images/6.png") + " cannot be read: left out of the map", told);
            const Location location = localizer.localize(image * 0.3, CAMERA);
            ASSERT_TRUE(location.found) << location.reason;
            const cv::Vec3d away = location.cameraFromWorld.inv().translation() - unit * truth.translation();
            EXPECT_LT(cv::norm(away), 0.01 * unit);
            EXPECT_GT(location.inliers, 200);
        }
}

TEST_F(Mapping, a_damaged_model)
{
    const std::string begin = folder.path("sparse 0") + " is no COLMAP model in binary form";
    const Files whole = model(1, 2);
    for (const auto& [name, content] : whole)
        for (size_t length = 0; length <= content.size() + 1; length++)
        {
            Files files = whole;
            files[name].resize(length, '\2');
            const bool damaged = length != content.size();
            EXPECT_EQ(damaged, error(files).find(begin) == 0) << name << " of " << length << " bytes";
        }
    for (const auto& [name, place, value] :
            {std::make_tuple("cameras.bin", 12, 'c'), {"images.bin", 18, '\x7f'}, {"images.bin", 68, '\1'},
                    {"points3D.bin", 59, '\1'}, {"points3D.bin", 57, '\1'}})
    {
        Files files = whole;
        files[name][size_t(place)] = value;
        EXPECT_EQ(0u, error(files).find(begin)) << name << ", byte " << place;
    }
}

TEST_F(Mapping, a_model_of_others)
{
    EXPECT_NE(std::string::npos, error(model(1, 2, FOV)).find("FOV"));
    EXPECT_EQ(
            "none of the model's images can be read below " + folder.path("map"), error(model(1, 2), "map"));
    cv::imwrite(folder.path("images/3.png"), cv::Mat(240, 300, CV_8U, cv::Scalar(9)));
    EXPECT_NE(std::string::npos,
            error(model(1, 2)).find("3.png has 300 x 240 pixels and its camera in the model 320 x 240"));
    for (int i = 0; i < 6; i++)  // in another order
        cv::imwrite(
                folder.path("images/" + std::string(i < 3 ? "left side/" : "") + std::to_string(i) + ".png"),
                wall.image(poseAt(0.9 - 0.4 * (i * 4 % 6), 0.3 * (i * 5 % 3), -0.1 * i)));
    EXPECT_NE(std::string::npos, error(model(1, 2)).find("is this the model of these images?"));
}

}  // namespace
