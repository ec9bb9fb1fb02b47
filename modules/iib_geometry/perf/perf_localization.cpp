// SPDX-License-Identifier: Apache-2.0
#include "perf_precomp.hpp"

#include <fstream>
#include <sstream>

#include "opencv2/core/quaternion.hpp"
#include "opencv2/core/utils/filesystem.hpp"

namespace opencv_test { namespace {

//! Strecha's entry-P10 below OPENCV_TEST_DATA_PATH: ten photographs of 768 x 512 pixels, with poses.
std::string entry(const std::string& name)
{
    const char* data = getenv("OPENCV_TEST_DATA_PATH");
    return std::string(data ? data : "") + "/strecha/entry-P10/" + name;
}

Mat read(const std::string& name) { return imread(entry("images/" + name), IMREAD_GRAYSCALE); }

std::vector<PosedImage> posedImages(const Camera& camera)
{
    std::ifstream poses(entry("poses.txt"));
    std::vector<PosedImage> images;
    for (std::string line; std::getline(poses, line);)
    {
        PosedImage image;
        image.camera = camera;
        Vec3d centre;
        Quatd turn;
        std::istringstream stream(line);
        if (stream >> image.name >> centre[0] >> centre[1] >> centre[2] >> turn.x >> turn.y >> turn.z >>
                turn.w)
        {
            image.name += ".jpg";
            image.cameraFromWorld = Affine3d(Mat(turn.toRotMat3x3()), centre).inv();
            images.push_back(image);
        }
    }
    return images;
}

typedef perf::TestBaseWithParam<int> IIB_Localize;  // points

PERF_TEST_P(IIB_Localize, relit_among_ten, testing::Values(1000, 2000))
{
    const Camera camera = Camera::parse("PINHOLE,768,512,689.87,691.04,380.2975,251.8275");
    const std::vector<PosedImage> images = posedImages(camera);
    if (images.empty())
        throw SkipTestException("no strecha/entry-P10 below OPENCV_TEST_DATA_PATH");
    const std::string model = tempfile();
    utils::fs::createDirectories(model);
    writeModel(model, images);
    const Localizer localizer(model, read, GetParam());
    utils::fs::remove_all(model);
    Mat image;
    read("0004.jpg").convertTo(image, CV_8U, .5, 20);
    Location location;
    const Threads one(1);
    TEST_CYCLE() location = localizer.localize(image, camera);
    EXPECT_TRUE(location.found) << location.reason;
    SANITY_CHECK_NOTHING();
}

}}  // namespace opencv_test
