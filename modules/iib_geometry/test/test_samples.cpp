// SPDX-License-Identifier: Apache-2.0

#if defined IIB_SAMPLE_LOCALIZE && !defined _WIN32  // the sample's path; needs a POSIX shell

#include <cstdlib>

#include "wall.hpp"

namespace {
using namespace opencv_test;

class Sample : public WallTest
{
protected:
    //! The fields of the lines on standard output.
    std::vector<std::vector<std::string>> localize(const std::string& arguments, int expected)
    {
        const std::string line = "'" IIB_SAMPLE_LOCALIZE "' '" + folder.path("map") + "' " + arguments +
                                 " >'" + folder.path("said") + "' 2>'" + folder.path("error") + "'";
        EXPECT_EQ(expected << 8, std::system(line.c_str())) << textOf(folder.path("error"));
        std::vector<std::vector<std::string>> rows;
        std::istringstream text(textOf(folder.path("said")));
        for (std::string row; std::getline(text, row);)
        {
            rows.emplace_back();
            std::istringstream fields(row);
            for (std::string field; std::getline(fields, field, ',');)
                rows.back().push_back(field);
        }
        return rows;
    }

    //! Expects a row with a pose at this position.
    static void expectPose(const std::vector<std::string>& row, const cv::Affine3d& truth)
    {
        ASSERT_EQ(13u, row.size());
        EXPECT_EQ("1", row[1]) << row[2];
        double v[8];
        for (size_t i = 0; i < 8; i++)
            v[i] = std::stod(row[5 + i]);
        EXPECT_LT(cv::norm(cv::Vec3d(v) - truth.translation()), 0.02);
        const cv::Matx33d rotation = cv::Quatd(v[6], v[3], v[4], v[5]).toRotMat3x3();
        EXPECT_LT(cv::norm(cv::Affine3d(rotation * truth.rotation().t()).rvec()), 0.01);
        EXPECT_GT(v[7], 0);
        EXPECT_LT(v[7], 0.02);
    }
};

TEST_F(Sample, images_and_a_stream_of_names)
{
    const cv::Affine3d place = poseAt(0.1, -0.1, 0.1);
    const std::string dark = folder.path("a \"b\".png"), none = folder.path("none.png");
    cv::imwrite(dark, wall.image(place) * 0.3);
    auto rows = localize("map '" + dark + "' '" + none + "'", 4);
    ASSERT_EQ(3u, rows.size());
    EXPECT_EQ("name", rows[0][0]);
    EXPECT_EQ(13u, rows[0].size());
    EXPECT_EQ("\"" + folder.path("a \"\"b\"\".png") + "\"", rows[1][0]);
    expectPose(rows[1], place);
    EXPECT_EQ("the image cannot be read", rows[2].at(2));

    folder.write("names", dark + "\n" + dark + "\n");
    rows = localize("PINHOLE,320,240,260,260,160,120 <'" + folder.path("names") + "'", 0);
    ASSERT_EQ(3u, rows.size());
    for (size_t i : {1, 2})
        expectPose(rows[i], place);
    EXPECT_EQ(
            "\"it has 320 x 240 pixels", localize("PINHOLE,64,48,50,50,32,24 '" + dark + "'", 3).at(1).at(2));
    localize("FISH '" + dark + "'", 1);
    localize("", 2);
}

}  // namespace

#endif
