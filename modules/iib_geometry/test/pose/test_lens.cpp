// SPDX-License-Identifier: Apache-2.0

#include "../derivatives.hpp"
#include "pose/camera_pose.hpp"
#include "pose/lens.hpp"
#include "../wall.hpp"

namespace opencv_test { namespace {
using namespace cv::iib;

//! Pixels of two points in cameras of 640 x 480 pixels by pycolmap 4.2.1, Camera.img_from_cam, minus half a pixel.
TEST(Lens, of_colmaps_definitions)
{
    const std::vector<cv::Point3d> points = {{.5, -.4, 1}, {-1.2, .8, 1.5}};
    const struct
    {
        const char* camera;
        double seen[4];
    } cases[] = {
            {"SIMPLE_PINHOLE,640,480,500,320,240", {569.5, 39.5, -80.5, 506.1666666667}},
            {"PINHOLE,640,480,500,510,320,240", {569.5, 35.5, -80.5, 511.5}},
            {"SIMPLE_RADIAL,640,480,500,320,240,0.1",
                    {579.7500000000, 31.3000000000, -117.4777777778, 530.8185185185}},
            {"RADIAL,640,480,500,320,240,0.1,-0.05",
                    {577.6487500000, 32.9810000000, -100.3858271605, 519.4238847737}},
            {"OPENCV,640,480,500,510,320,240,0.1,-0.05,0.01,-0.02",
                    {566.5487500000, 36.6536200000, -126.6969382716, 541.3423624691}},
            {"OPENCV_FISHEYE,640,480,500,510,320,240,0.05,-0.02,0.01,-0.003",
                    {545.0729994052, 55.4324324854, -6.7555225391, 461.3537553266}},
            {"FULL_OPENCV,640,480,500,510,320,240,0.1,-0.05,0.01,-0.02,0.03,0.02,-0.01,0.005",
                    {565.3023810330, 37.6706570770, -130.2938059060, 543.7882324605}},
            {"FOV,640,480,500,510,320,240,0.9",
                    {559.8309151878, 43.3899732068, -26.5184021608, 474.7925134693}},
            {"SIMPLE_RADIAL_FISHEYE,640,480,500,320,240,0.05",
                    {545.4724218834, 58.7220624933, -8.4170539646, 458.1113693097}},
            {"RADIAL_FISHEYE,640,480,500,320,240,0.05,-0.02",
                    {545.0044934849, 59.0964052121, -6.2261647060, 456.6507764707}},
            {"THIN_PRISM_FISHEYE,640,480,500,510,320,240,0.05,-0.02,0.01,-0.02,0.01,-0.003,0.004,-0.005",
                    {536.9400178225, 60.7786020423, -22.2723678022, 470.2105360458}},
            {"RAD_TAN_THIN_PRISM_FISHEYE,640,480,500,510,320,240,0.05,-0.02,0.01,-0.003,0.002,-0.001,0.01,-0."
             "02,0.004,-0.005,0.003,-0.002",
                    {552.4242818266, 48.1054649258, 6.5097118804, 448.8991047259}},
            {"SIMPLE_DIVISION,640,480,500,320,240,-0.1",
                    {560.0131607954, 47.0894713637, -49.0998863802, 485.2332575868}},
            {"DIVISION,640,480,500,510,320,240,-0.1",
                    {560.0131607954, 43.2412607909, -49.0998863802, 490.1479227385}},
            {"SIMPLE_FISHEYE,640,480,500,320,240",
                    {541.8659804740, 61.6072156208, 0.9234884263, 451.8843410491}},
            {"FISHEYE,640,480,500,510,320,240",
                    {541.8659804740, 58.0493599332, 0.9234884263, 456.1320278701}},
            {"EUCM,640,480,500,510,320,240,0.6,1.1",
                    {542.1685949245, 57.8024265416, 0.0375352423, 456.7344760353}},
    };
    for (const auto& c : cases)
    {
        SCOPED_TRACE(c.camera);
        const Camera camera = Camera::parse(c.camera);
        const Lens lens(camera);
        const std::vector<cv::Point2d> seen = camera.project(points),
                                       half = camera.resized({320, 240}).project(points);
        for (size_t i = 0; i < 2; i++)
        {
            EXPECT_NEAR(c.seen[2 * i], seen[i].x, 1e-8);
            EXPECT_NEAR(c.seen[2 * i + 1], seen[i].y, 1e-8);
            EXPECT_LT(cv::norm((seen[i] - cv::Point2d(.5, .5)) * .5 - half[i]), 1e-9)
                    << "of a pixel's centre";
        }
        const cv::Vec3d straight = lens.matrix() * (cv::Vec3d(points[0]) * (1 / points[0].z));
        EXPECT_LT(cv::norm(lens.undistorted(seen)[0] - cv::Point2d(straight[0], straight[1])), 1e-6);
        EXPECT_TRUE(std::isnan(camera.project({{0, 0, -1}})[0].x)) << "behind";
        std::vector<cv::Matx23d> slopes;
        lens.project(points, &slopes);
        const auto seenAt = [&](const Numbers& step) {
            const cv::Point2d at = lens.project({cv::Vec3d(points[1]) + cv::Vec3d(step.data())})[0];
            return Numbers{at.x, at.y};
        };
        expectDerivatives(cv::Mat_<double>(cv::Mat(slopes[1])), seenAt, 1e-6);
    }
    EXPECT_TRUE(
            std::isnan(Lens(Camera::parse("FISHEYE,640,480,100,100,320,240")).undistorted({{700, 240}})[0].x))
            << "more than a right angle from the axis";
}

//! Models whose polynomials are not monotonic, and lenses of 140 degrees and more.
const char* const WIDE[] = {"SIMPLE_RADIAL,640,480,300,320,240,-0.3", "RADIAL,640,480,300,320,240,-0.3,0.05",
        "OPENCV,640,480,300,310,320,240,-0.28,0.06,0.002,-0.003",
        "FULL_OPENCV,640,480,300,310,320,240,-0.3,0.08,0.001,-0.002,-0.01,0.02,-0.01,0.005",
        "OPENCV_FISHEYE,1280,960,400,400,640,480,0.02,-0.01,0.003,-0.001",
        "OPENCV_FISHEYE,1280,960,400,410,640,480,-0.2,-0.05,0.01,0",
        "THIN_PRISM_FISHEYE,640,480,180,181,320,240,0.05,-0.02,0.001,-0.002,-0.03,-0.003,0.004,-0.005",
        "RAD_TAN_THIN_PRISM_FISHEYE,640,480,180,181,320,240,0.05,-0.02,0.01,-0.03,0,0,0.001,-0.002,0.001,0,0."
        "001,0",
        "THIN_PRISM_FISHEYE,640,480,200,200,320,240,0,0,0,0,0,0,0.001,0.001",
        "RAD_TAN_THIN_PRISM_FISHEYE,640,480,200,200,320,240,0,0,0,0,0,0,0,0,0.001,0,0.001,0",
        "FOV,640,480,200,200,320,240,1.2", "SIMPLE_DIVISION,640,480,300,320,240,-0.4",
        "SIMPLE_DIVISION,640,480,300,320,240,0.2", "SIMPLE_FISHEYE,640,480,160,320,240",
        "EUCM,640,480,200,200,320,240,0.7,1.3", "PINHOLE,640,480,100,100,320,240"};

TEST(Lens, points_farther_from_the_axis_are_seen_farther_or_not_at_all)
{
    for (const char* text : WIDE)
        for (double direction = 0; direction < 6.2; direction += .5)
        {
            SCOPED_TRACE(text);
            const Lens lens(Camera::parse(text));
            const cv::Matx33d matrix = lens.matrix();
            double last = -1;
            for (double degrees = 0; degrees < 89.9; degrees += .25)
            {
                const double angle = degrees * CV_PI / 180;
                const cv::Point3d point(std::sin(angle) * std::cos(direction),
                        std::sin(angle) * std::sin(direction), std::cos(angle));
                const cv::Point2d seen = lens.project({point})[0];
                const double far = (seen.x - matrix(0, 2)) / matrix(0, 0) * std::cos(direction) +
                                   (seen.y - matrix(1, 2)) / matrix(1, 1) * std::sin(direction);
                if (last < HUGE_VAL && std::isnan(far))
                    last = HUGE_VAL;  // beyond the lens's range no point is seen
                else if (last < HUGE_VAL)
                {
                    EXPECT_GT(far, last) << degrees;
                    last = far;
                }
                else
                    EXPECT_TRUE(std::isnan(far)) << degrees;
            }
        }
    const Camera camera = Camera::parse("SIMPLE_RADIAL,640,480,300,320,240,-0.3");
    EXPECT_TRUE(std::isnan(camera.project({{std::tan(61 * CV_PI / 180), 0, 1}})[0].x));
    EXPECT_NEAR(1 / std::sqrt(.9),
            (camera.undistorted({camera.project({{1.054, 0, 1}})[0]})[0].x - 319.5) / 300, .001)
            << "where 1 - .9 r^2 is 0";
}

TEST(Lens, every_pixel_is_where_its_ray_is_seen)
{
    for (const char* text : WIDE)
    {
        SCOPED_TRACE(text);
        const Camera camera = Camera::parse(text);
        const Lens lens(camera);
        std::vector<cv::Point2d> pixels;
        for (int y = 0; y < camera.size.height; y += 20)
            for (int x = 0; x < camera.size.width; x += 20)
                pixels.emplace_back(x, y);
        const std::vector<cv::Point2d> straight = camera.undistorted(pixels);
        const cv::Matx33d back = camera.matrix().inv();
        // Pixels with a ray lie inside those of points at 89 degrees, or at the lens's range if that is less.
        std::vector<cv::Point3d> rim;
        for (int degrees = 1; degrees < 90; degrees++)
            rim.emplace_back(std::tan(degrees * CV_PI / 180), 0, 1);
        double radius = 0;
        for (const cv::Point2d& seen : camera.project(rim))
            radius = std::max(radius,
                    std::isnan(seen.x) ? 0 : (seen.x - camera.matrix()(0, 2)) / camera.matrix()(0, 0));
        for (size_t i = 0; i < pixels.size(); i++)
        {
            const cv::Vec3d seen = back * cv::Vec3d(pixels[i].x, pixels[i].y, 1),
                            ray = back * cv::Vec3d(straight[i].x, straight[i].y, 1);
            if (std::isnan(straight[i].x))
                EXPECT_GT(std::hypot(seen[0], seen[1]), .9 * radius) << pixels[i];
            else
                EXPECT_LT(cv::norm(lens.project({ray})[0] - pixels[i]), 1e-5) << pixels[i];
        }
    }
}

TEST(Lens, resized_to_the_same_shape)
{
    const Camera camera = Camera::parse("PINHOLE,641,480,500,510,320,240");
    EXPECT_EQ(cv::Size(320, 240), camera.resized({320, 240}).size);
    EXPECT_EQ(cv::Size(100, 75), camera.resized({100, 75}).size);
    EXPECT_EQ("a camera of 641 x 480 pixels cannot be resized to 0 x 0: give a size of the same shape",
            messageOf([&] {
                camera.resized({0, 0});
            }));
    for (const cv::Size size :
            {cv::Size(240, 320), cv::Size(640, 470), cv::Size(-641, -480), cv::Size(320, 0)})
        EXPECT_NE("", messageOf([&] { camera.resized(size); })) << size;
}

TEST(Lens, cameras_that_are_none)
{
    const auto error = [](const char* text) { return messageOf([&] { Camera::parse(text); }); };
    EXPECT_EQ("camera PINHOLE,640,480 is not MODEL,WIDTH,HEIGHT,PARAMETERS", error("PINHOLE,640,480"));
    for (const char* text : {"", "PINHOLE", "PINHOLE,", "PINHOLE,640,480,1,", "PINHOLE,640,480,1 ,1",
                 "PINHOLE,640,480,inf,1,1,1"})
        EXPECT_EQ(std::string("camera ") + text + " is not MODEL,WIDTH,HEIGHT,PARAMETERS", error(text));
    for (const char* size : {"640,4e9", "640.5,480", "0,480", "-640,480"})
        EXPECT_EQ(std::string("camera PINHOLE,") + size +
                          ",1,1,1,1: width and height are whole numbers of pixels",
                error((std::string("PINHOLE,") + size + ",1,1,1,1").c_str()));
    EXPECT_EQ("camera PINHOLE,640,480,x,1,1,1 is not MODEL,WIDTH,HEIGHT,PARAMETERS",
            error("PINHOLE,640,480,x,1,1,1"));
    EXPECT_EQ("camera model PINHOLE has 4 parameters, not 3", error("PINHOLE,640,480,500,320,240"));
    for (const char* focal : {"500,0", "-500,500", "1e30,500", "500,.1"})
        EXPECT_EQ("a camera's size and focal length must be positive, and not a thousand times each other",
                error((std::string("PINHOLE,640,480,") + focal + ",320,240").c_str()));
    EXPECT_EQ("a camera's parameters must be finite, and its centre not a thousand widths away",
            error("PINHOLE,640,480,500,500,1e30,240"));
    EXPECT_EQ("a camera's size and focal length must be positive", messageOf([] {
        Lens({"PINHOLE", {0, 480}, {500, 500, 320, 240}});
    }));
    EXPECT_EQ(0u, error("EQUIRECTANGULAR,640,480,1,1")
                          .find("camera model EQUIRECTANGULAR is not one of SIMPLE_PINHOLE, PINHOLE"));
}

// The third match is of a line: only its error perpendicular to the line counts.
TEST(Pose, derivatives_are_those_of_finite_differences)
{
    const Lens lens(Camera::parse("OPENCV,640,480,500,510,320,240,-0.1,0.05,0.001,-0.002"));
    const cv::Affine3d pose(cv::Vec3d(.1, .3, -.2), cv::Vec3d(.5, -1, 2));
    std::vector<Match> matches;
    for (const cv::Point3d& seen : {cv::Point3d(.5, -.4, 3), {-1.2, .8, 4}, {.2, 1, 5}})
        matches.push_back({{300, 200}, inverse(pose) * seen});
    matches[2].errorProjection = {.36, .48, .48, .64};
    const auto seenAt = [&](const Numbers& step) {
        Numbers places;
        for (const LinearMatch& m : linearize(matches, lens, moved(pose, cv::Vec6d(step.data()))))
            places.insert(places.end(), {-m.error[0], -m.error[1]});
        return places;
    };
    cv::Mat_<double> analytic;
    for (const LinearMatch& m : linearize(matches, lens, pose))
        analytic.push_back(cv::Mat(m.byPose));
    expectDerivatives(analytic, seenAt, 1e-6);
}

TEST(Pose, refined_to_the_truth_among_wrong_matches)
{
    cv::RNG random(3);
    for (const char* text :
            {"PINHOLE,640,480,500,510,320,240", "OPENCV,640,480,500,510,320,240,-0.1,0.05,0.001,-0.002",
                    "OPENCV_FISHEYE,640,480,400,410,320,240,0.02,0,0,-0.01"})
    {
        const Lens lens(Camera::parse(text));
        const cv::Affine3d truth(cv::Vec3d(0.1, 0.3, -0.2), cv::Vec3d(0.5, -1, 2));
        std::vector<Match> matches;
        for (int i = 0; i < 200; i++)
        {
            const double z = random.uniform(4., 9.), y = random.uniform(-1.5, 1.5),
                         x = random.uniform(-2., 2.);
            const double wrongY = random.uniform(-30., 30.), wrongX = random.uniform(-30., 30.);
            const cv::Point3d seen(x, y, z);
            const cv::Point2d wrong(wrongX, wrongY);
            matches.push_back(
                    {lens.project({seen})[0] + (i % 4 == 0 ? wrong : cv::Point2d()), inverse(truth) * seen});
        }
        cv::Affine3d pose;
        ASSERT_TRUE(poseByRansac(matches, lens, 4, pose));
        cv::Matx66d covariance;
        ASSERT_TRUE(refinePose(matches, lens, pose, covariance));
        EXPECT_LT(cv::norm((pose * inverse(truth)).translation()), 0.01) << text;
        EXPECT_LT(cv::norm((pose * inverse(truth)).rvec()), 0.002) << text;
    }
}

}}  // namespace opencv_test
