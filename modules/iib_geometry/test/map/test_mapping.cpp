// SPDX-License-Identifier: Apache-2.0

#include <filesystem>

#include "../derivatives.hpp"
#include "map/colmap_model.hpp"
#include "map/triangulation.hpp"
#include "../wall.hpp"

#ifndef _WIN32
#include <sys/stat.h>
#endif

namespace opencv_test { namespace {
using namespace cv::iib;

constexpr uint32_t EQUIRECTANGULAR = 17;  // number of the camera model in COLMAP
const cv::iib::MapOptions FEW(400);       // points an image, since matching time is quadratic

struct Mapping : public WallTest
{
    Mapping() { write(model(1, 40)); }

    //! The path of a map that is made of the model.
    std::string made(const MapOptions& options = FEW) const
    {
        buildMap(sparse, images(), folder.path("new/map"), options);
        return folder.path("new/map");
    }

    std::string error(const Files& files, const std::string& photographs = "images") const
    {
        write(files);
        return messageOf([&] { Localizer(sparse, images(photographs)); });
    }

    const std::string sparse = folder.path("sparse 0");
};

TEST_F(Mapping, images_are_localized_in_a_map)
{
    size_t last = 0, all = 0;
    std::string problems;
    const auto progress = [&](size_t done, size_t of, const std::string& problem) {
        EXPECT_EQ(++last, done);
        all = of;
        problems += problem;
    };
    const Localizer localizer(sparse, images(), 1000, progress);
    EXPECT_EQ(7u + 21u, all);
    EXPECT_EQ(all, last);
    EXPECT_EQ("6.png cannot be read: left out of the map", problems);
    const Location location = localizer.localize(wall.image(TRUTH) * 0.3, CAMERA);
    expectAt(TRUTH, location, 0.01);
    EXPECT_GT(location.inliers, 200);
}

#if CV_VERSION_MAJOR < 5
TEST_F(Mapping, maps_of_orb_and_akaze_points)
{
    MapOptions options;
    options.orbAndAkaze = true;
    const std::string path = made(options);
    EXPECT_TRUE(readMap(path).orbAndAkaze);
    expectAt(TRUTH, Localizer(path).localize(wall.image(TRUTH) * .5, CAMERA), .02);
    EXPECT_EQ(170, readMap(path).images[0].codes.cols) << "the default's";
}
#endif

// Errors and standard deviations scale with the unit, wherever the origin is.
TEST_F(Mapping, in_any_unit_and_far_from_the_origin)
{
    const cv::Mat image = wall.image(TRUTH);
    for (const auto& [unit, far] : {std::make_pair(1e-8, 0.), {1e-5, 0.}, {250., 0.}, {1e9, 0.}, {1e12, 0.},
                 {1., 1e4}, {1., 1e6}, {1., 1e8}, {1e-3, 1e3}, {1e4, 1e11}})
        for (int points : {0, 40})
        {
            SCOPED_TRACE(cv::format("unit %g, %g away, %d points", unit, far, points));
            const cv::Vec3d origin(far, -.7 * far, .3 * far);
            write(model(unit, points, 1, origin));
            const Localizer localizer(sparse, images(), 400, {}, FEW);
            const Location location = localizer.localize(image, CAMERA);
            ASSERT_TRUE(location.found) << location.reason;
            const cv::Vec3d away = centre(location) - unit * TRUTH.translation() - origin;
            EXPECT_LT(cv::norm(away), 0.01 * unit);
            EXPECT_GT(location.inliers, 300);
            for (int i = 0; i < 3; i++)
                EXPECT_LT(std::abs(away[i]), 5 * std::sqrt(location.covariance(i, i))) << i;
            const Location again = localizer.localize(image, CAMERA, &location.cameraFromWorld);
            EXPECT_TRUE(again.found && again.matches < location.matches) << "near its prior";
        }
}

// The map's images have errors of 2 mm and .06 degrees. A covariance from matches alone would report a twentieth of
// that.
TEST_F(Mapping, the_maps_own_error_is_reported)
{
    double reported[2] = {0, 0}, squared = 0;
    constexpr int COUNT = 8;
    for (int wrong = 0; wrong < 2; wrong++)
    {
        cv::RNG random(7);
        std::vector<PosedImage> model;
        for (const MapImage& image : map.images)
        {
            cv::Vec3d moved, turned;
            random.fill(moved, cv::RNG::NORMAL, 0, .002);
            random.fill(turned, cv::RNG::NORMAL, 0, .001);
            const cv::Affine3d off(turned * wrong, moved * wrong);
            model.push_back({image.name, CAMERA, off * image.cameraFromWorld, {}, {}});
        }
        folder.makeFolder("off");
        writeModel(folder.path("off"), model);
        const Localizer localizer(folder.path("off"), images());
        for (int i = 0; i < COUNT; i++)
        {
            const cv::Affine3d truth = poseAt(.1 * i - .5, -.05, .01 * i);
            const Location found = localizer.localize(wall.image(truth), CAMERA);
            ASSERT_TRUE(found.found) << found.reason;
            const cv::Matx33d covariance = found.covariance.get_minor<3, 3>(0, 0);
            const cv::Vec3d error = centre(found) - truth.translation();
            reported[wrong] += cv::trace(covariance) / COUNT;
            squared += wrong * error.dot(covariance.inv() * error) / COUNT;
        }
    }
    EXPECT_LT(squared, 3 * 3) << "of three degrees of freedom";
    EXPECT_GT(squared, 3 * .1);
    EXPECT_GT(reported[1], 10 * reported[0]);
}

TEST_F(Mapping, a_map_on_disk_equals_one_in_memory)
{
    const std::string path = made();
    const cv::Mat image = wall.image(TRUTH);
    const Location first = Localizer(sparse, images(), 400, {}, FEW).localize(image, CAMERA),
                   second = Localizer(path, 400).localize(image, CAMERA);
    EXPECT_TRUE(first.found);
    EXPECT_EQ(first.cameraFromWorld.matrix, second.cameraFromWorld.matrix);
    EXPECT_EQ(first.covariance, second.covariance);
    // The folder is a COLMAP model too.
    const std::vector<PosedImage> back = readModel(path);
    ASSERT_EQ(7u, back.size());
    EXPECT_EQ("left side/1.png", back[1].name);
    EXPECT_EQ(0u, indexOf(CAMERA, {back[1].camera}));
    EXPECT_LT(cv::norm(back[1].cameraFromWorld.matrix, inverse(pathPose(1)).matrix), 1e-9);
    EXPECT_GT(back[1].sees.size(), 200u);
}

TEST_F(Mapping, larger_images_are_reduced_but_points_are_in_full_pixels)
{
    MapOptions options = FEW;
    options.maxSize = 160;
    const std::string path = made(options);
    const MapImage image = readMap(path).images[0];
    EXPECT_EQ(cv::Size(160, 120), image.picture.pixels.size());
    EXPECT_NEAR(.5, image.picture.scale, 1e-9);
    EXPECT_EQ(SIZE, image.camera.size);
    // The detector's smallest blobs have a sigma of 2.2, and none lie nearer to the border than 2 sigma.
    EXPECT_GT(*std::min_element(image.sizes.begin(), image.sizes.end()), 2 * 4.f);
    cv::Rect2d all(image.pixels[0], cv::Size2d());
    for (const cv::Point2d& pixel : image.pixels)
        all |= cv::Rect2d(pixel, cv::Size2d(1e-3, 1e-3));
    EXPECT_GT(all.br().x, 280);
    EXPECT_LT(all.br().x, 311);
    const Location location = Localizer(path).localize(wall.image(TRUTH) * .5, CAMERA);
    expectAt(TRUTH, location, .01);
    // Files store pixels as floats, and the scale of a picture by its size.
    const Localizer inMemory(sparse, images(), 1000, {}, options);
    EXPECT_LT(cv::norm(location.covariance, inMemory.localize(wall.image(TRUTH) * .5, CAMERA).covariance,
                      cv::NORM_L2 | cv::NORM_RELATIVE),
            1e-4);
    options.maxSize = 31;
    EXPECT_NE(std::string::npos, messageOf([&] { made(options); }).find("maxSize is 31"));
}

TEST_F(Mapping, pictures_in_the_map_make_poses_more_accurate)
{
    const std::string with = made(), without = folder.path("without");
    Map plain = readMap(with);
    for (MapImage& image : plain.images)
        image.picture = Picture();
    MapFolder(without).write(plain);
    const Localizer refined(with), detected(without);
    double errors[2] = {0, 0};
    for (int i = 0; i < 10; i++)
    {
        const cv::Affine3d truth = poseAt(0.08 * i - 0.4, -0.1, 0.01 * i);
        const cv::Mat image = wall.image(truth) * 0.4;
        int which = 0;
        for (const Localizer* localizer : {&refined, &detected})
        {
            const Location location = localizer->localize(image, CAMERA);
            ASSERT_TRUE(location.found) << location.reason;
            errors[which++] += cv::norm(centre(location) - truth.translation());
        }
    }
    EXPECT_LT(errors[0], .8 * errors[1]);
}

TEST_F(Mapping, images_that_share_no_points_are_paired_with_the_nearest)
{
    Files files = model(1, 1);
    std::string& posed = files["images.bin"];
    for (size_t image = 0, at = 8; image < 7; image++)  // each image sees a different point
    {
        at = posed.find('\0', at + 64) + 1 + 8 + 16;
        posed[at] = char(image);
        at += 8;
    }
    write(files);
    EXPECT_EQ("", messageOf([&] { Localizer(sparse, images(), 400, {}, FEW); }));
}

//! An image that sees one point, with an error of its pixel.
MapImage imageOf(const cv::Point3d& point, const cv::Affine3d& pose, const cv::Point2d& error)
{
    MapImage image;
    image.camera = CAMERA;
    image.cameraFromWorld = inverse(pose);
    image.pixels = {CAMERA.project({image.cameraFromWorld * point})[0] + error};
    image.sees = {-1};
    return image;
}

TEST(Triangulation, an_outlier_ray_is_left_out)
{
    Map map;
    const cv::Point3d truth(.2, -.1, 5);
    std::vector<Ray> rays;
    for (int i = 0; i < 3; i++)
    {
        const MapImage image = imageOf(truth, poseAt(i - 1., 0, 0), {0, i == 2 ? 30. : 0.});
        map.images.push_back(image);
        rays.push_back(raysOf(size_t(i), image)[0]);
    }
    triangulate(map, rays, {{1, 0, 1}, {2, 0, 2}});
    ASSERT_EQ(1u, map.points.size());
    EXPECT_LT(cv::norm(map.points[0] - truth), 1e-6);
    EXPECT_EQ(0, map.images[0].sees[0]);
    EXPECT_EQ(0, map.images[1].sees[0]);
    EXPECT_EQ(-1, map.images[2].sees[0]);
}

// The derivatives of Cauchy's loss vanish at the point.
TEST(Triangulation, a_point_minimizes_the_loss_of_its_rays)
{
    const cv::Point3d truth(.2, -.1, 5);
    const double errors[] = {1, -.7, .4, -2.5, .3};  // pixels
    Track track;
    for (int i = 0; i < 5; i++)
        track.push_back(raysOf(size_t(i),
                imageOf(truth, poseAt(.5 * i - 1, .2 * (i % 2), 0), {errors[i], errors[(i + 2) % 5]}))[0]);
    cv::Point3d point;
    ASSERT_TRUE(triangulatePoint(track, point));
    ASSERT_EQ(5u, track.size());
    const auto lossAt = [&](const Numbers& step) {
        double loss = 0;
        for (const Ray& ray : track)
            loss += std::log1p(std::pow(ray.error(cv::Vec3d(point) + cv::Vec3d(step.data())), 2));
        return Numbers{loss};
    };
    expectDerivatives(cv::Mat_<double>(1, 3, 0.), lossAt, 5);  // within a hundredth of a pixel
}

// In the second image a decoy 20 pixels above each keypoint has its exact code, and the keypoint's own code has noise.
TEST(Rays, keypoints_are_matched_along_epipolar_lines)
{
    constexpr size_t COUNT = 40;
    cv::RNG random(1);
    std::vector<MapImage> images(2);
    for (int i : {0, 1})
    {
        images[size_t(i)].camera = CAMERA;
        images[size_t(i)].cameraFromWorld = inverse(poseAt(.5 * i, 0, 0));
    }
    for (size_t n = 0; n < COUNT; n++)
    {
        const double z = random.uniform(4., 6.), y = random.uniform(-1., 1.), x = random.uniform(-1., 1.);
        const cv::Point3d point(x, y, z);
        cv::Mat code(1, 64, CV_8U);
        random.fill(code, cv::RNG::UNIFORM, 0, 256);
        const cv::Mat changed = code ^ cv::Mat(1, 64, CV_8U, cv::Scalar(1));
        for (MapImage& image : images)
        {
            const bool second = &image == &images[1];
            image.pixels.push_back(CAMERA.project({image.cameraFromWorld * point})[0]);
            image.codes.push_back(second ? changed : code);
            if (second)
            {
                image.pixels.push_back(image.pixels.back() - cv::Point2d(0, 20));
                image.codes.push_back(code);
            }
        }
    }
    const MatchedRays found = matchPairs(images, {{0, 1}});
    EXPECT_EQ(COUNT, found.matches);
    EXPECT_EQ(0u, found.consistent) << "without the poses";
    ASSERT_EQ(COUNT, found.links.size());
    for (const RayMatch& link : found.links)
        EXPECT_EQ(2 * found.rays[link.a].keypoint, found.rays[link.b].keypoint);
}

TEST_F(Mapping, models_as_text)
{
    const std::string path = folder.path("text");
    folder.makeFolder("text");
    folder.write("text/cameras.txt", "# Cameras\n5 PINHOLE 320 240 260 260 160 120\n");
    std::string text = "# Images\n#\n";
    for (int i = 0; i < 6; i++)
    {
        const cv::Affine3d pose = inverse(pathPose(i));
        const cv::Quatd q = cv::Quatd::createFromRotMat(pose.rotation());
        const cv::Vec3d t = pose.translation();
        text += cv::format("%d %.17g %.17g %.17g %.17g %.17g %.17g %.17g 5 %s\r\n%s\n", i + 1, q.w, q.x, q.y,
                q.z, t[0], t[1], t[2], pathName(i).c_str(), i == 2 ? "" : "7.5 8.25 3 9 9 -1");
    }
    folder.write("text/images.txt", text);
    const std::vector<PosedImage> read = readModel(path);
    ASSERT_EQ(6u, read.size());
    EXPECT_EQ("left side/2.png", read[2].name);
    EXPECT_TRUE(read[2].sees.empty());
    EXPECT_EQ((std::vector<int>{0, -1}), read[3].sees);
    EXPECT_EQ(cv::Point2d(7, 7.75), read[3].pixels[0]);
    EXPECT_TRUE(Localizer(path, images(), 400, {}, FEW).localize(wall.image(TRUTH), CAMERA).found);
    for (const auto& [part, other] :
            {std::make_pair("5 3.png", "6 3.png"), {"5 3.png", "5 4.png"}, {"9 9 -1", "9 9"},
                    {"5 5.png\r\n7.5 8.25 3 9 9 -1\n", "5 5.png\r\n"}, {"5 5.png", "5"}, {" 8.25", " x"}})
    {
        std::string wrong = text;
        wrong.replace(wrong.rfind(part), std::string(part).size(), other);
        folder.write("text/images.txt", wrong);
        EXPECT_EQ(path + " is not a COLMAP model, or damaged: images.txt is missing or damaged",
                messageOf([&] { readModel(path); }))
                << other;
    }
}

TEST_F(Mapping, a_damaged_model)
{
    const std::string begin = sparse + " is not a COLMAP model, or damaged: ";
    const Files whole = model(1, 2);
    for (const auto& [name, content] : whole)
        for (size_t length = 0; length <= content.size() + 1; length++)
        {
            Files files = whole;
            files[name].resize(length, '\2');
            write(files);
            const std::string message = messageOf([&] { readModel(sparse); });
            EXPECT_EQ(length != content.size(), message.find(begin) == 0) << name << ' ' << length;
        }
    for (const auto& [name, place, value] :
            {std::make_tuple("cameras.bin", 12, 'c'), {"images.bin", 18, '\x7f'}, {"images.bin", 68, '\1'}})
    {
        Files files = whole;
        files[name][size_t(place)] = value;
        EXPECT_EQ(0u, error(files).find(begin)) << name << ", byte " << place;
    }
    Files twice = whole;
    std::string& images = twice["images.bin"];
    images[images.find("side/1.png") + 5] = '0';  // the name of another image
    EXPECT_EQ(begin + "images.bin is missing or damaged", error(twice));
    write(whole);
    const std::string above = folder.path("above");
    folder.makeFolder("above");
    std::filesystem::rename(sparse, above + "/0");
    EXPECT_EQ(above + " is not a COLMAP model, or damaged: cameras.bin is missing or damaged: did you mean " +
                      above + "/0?",
            messageOf([&] { readModel(above); }));
#ifndef _WIN32
    write(whole);
    std::filesystem::remove(sparse + "/images.bin");
    ASSERT_EQ(0, ::mkfifo((sparse + "/images.bin").c_str(), 0600));
    EXPECT_EQ(begin + "images.bin is missing or damaged", messageOf([&] { readModel(sparse); }));
#endif
}

TEST_F(Mapping, an_image_of_another_size_is_left_out)
{
    cv::imwrite(folder.path("images/5.png"), cv::Mat(240, 300, CV_8U, cv::Scalar(9)));
    std::set<std::string> problems;
    Localizer(sparse, images(), 300,
            [&](size_t, size_t, const std::string& problem) { problems.insert(problem); });
    EXPECT_EQ((std::set<std::string>{"", "6.png cannot be read: left out of the map",
                      "5.png: the image has 300 x 240 pixels and its camera 320 x 240: left out of the map"}),
            problems);
}

TEST_F(Mapping, a_model_of_other_images)
{
    EXPECT_NE(std::string::npos,
            error(model(1, 2, EQUIRECTANGULAR)).find("camera model 17 is not one of SIMPLE_"));
    const std::string none =
            "no keypoint was found in any of the model's images: give the images that it was "
            "made of; left side/0.png";
    EXPECT_EQ(none + " cannot be read: left out of the map", error(model(1, 2), "map"));
    for (int i = 0; i < 6; i++)
        cv::imwrite(folder.path("images/" + pathName(i)), cv::Mat(240, 300, CV_8U, cv::Scalar(9)));
    EXPECT_EQ(none + ": the image has 300 x 240 pixels and its camera 320 x 240: left out of the map",
            error(model(1, 2)));
    for (int i = 0; i < 6; i++)  // in another order
        cv::imwrite(folder.path("images/" + pathName(i)),
                wall.image(poseAt(0.9 - 0.4 * (i * 4 % 6), 0.3 * (i * 5 % 3), -0.1 * i)));
    EXPECT_NE(std::string::npos, error(model(1, 2)).find("is this the model of these images?"));
}

TEST_F(Mapping, a_model_is_read_as_it_was_written)
{
    const PosedImage image = {"one", CAMERA, poseAt(.1, .2, .3), {{10.25, 20.5}, {3, 4}, {7, 8}}, {0, -1, 1}};
    folder.makeFolder("model");
    writeModel(folder.path("model"), {image}, {{1, 2, 3}, {4, 5, 6}});
    const std::vector<PosedImage> again = readModel(folder.path("model"));
    ASSERT_EQ(1u, again.size());
    EXPECT_EQ(image.pixels, again[0].pixels);
    EXPECT_EQ(image.sees, again[0].sees);
    EXPECT_LT(cv::norm(image.cameraFromWorld.matrix, again[0].cameraFromWorld.matrix), 1e-12);
}

}}  // namespace opencv_test
