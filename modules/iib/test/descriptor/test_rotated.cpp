// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#include "../support/describe.hpp"

#include "../../src/descriptor/grid_pixels.hpp"

#include <memory>

namespace opencv_test { namespace {

Ptr<IIB> rotating(int granularity = 4, int channels = IIB::CHANNELS_DEFAULT)
{
    return IIB::create(2.f, granularity, channels, IIB::MAPPING_MEAN, false, true);
}

TEST(IIB_Rotated, sine_and_cosine_are_exact)
{
    for (int i = -800; i <= 800; i++)
    {
        const float degrees = i * 0.917f;
        const cv::iib::Rotation r(degrees);
        EXPECT_NEAR(std::cos(degrees * CV_PI / 180), r.cosine, 1e-14) << degrees;
        EXPECT_NEAR(std::sin(degrees * CV_PI / 180), r.sine, 1e-14) << degrees;
    }
    const double quarters[][2] = {{1, 0}, {0, 1}, {-1, 0}, {0, -1}, {1, 0}};
    for (int i = 0; i < 5; i++)
    {
        EXPECT_EQ(quarters[i][0], cv::iib::Rotation(90.f * i).cosine);
        EXPECT_EQ(quarters[i][1], cv::iib::Rotation(90.f * i).sine);
    }
    // whole turns change nothing, also beyond integers
    for (float degrees : {30.f + 360 * 4096, std::ldexp(31.f, 20), std::ldexp(211.f, 59)})
    {
        const cv::iib::Rotation whole(degrees), reduced(std::fmod(degrees, 360.f));
        EXPECT_EQ(reduced.sine, whole.sine);
        EXPECT_EQ(reduced.cosine, whole.cosine);
    }
}

// glibc 2.36 differs in the last place for all of these.
TEST(IIB_Rotated, sine_and_cosine_have_the_same_bits_everywhere)
{
    const struct
    {
        float degrees;
        double cosine, sine;
    } expected[] = {{43.3051186f, 0.72771148666394203, 0.68588336630753433},
            {10.f, 0.98480775301220802, 0.17364817766693036},
            {137.5f, -0.73727733681012397, 0.67559020761566024},
            {222.25f, -0.74021812748683213, -0.67236680743466803},
            {-17.2999992f, 0.9547608034625833, -0.29737486136437691},
            {1000.70001f, 0.18566682473406629, -0.98261275698678441}};
    for (const auto& e : expected)
    {
        const cv::iib::Rotation r(e.degrees);
        EXPECT_EQ(e.cosine, r.cosine) << e.degrees;
        EXPECT_EQ(e.sine, r.sine) << e.degrees;
    }
}

// A sine whose rounding moves the samples of a grid.
TEST(IIB_Rotated, grid_has_the_same_steps_everywhere)
{
    const KeyPoint keypoint(500, 400, 4246.43457f, 43.3051186f);
    const cv::iib::SupportRegion region(keypoint.pt, keypoint.size * 2.);
    const cv::iib::SampleGrid grid = cv::iib::gridOf(
            region, cv::iib::Rotation(keypoint.angle), 64, 1, IIB::BORDER_REFLECT, Size(1000, 800));
    EXPECT_EQ(6328687, grid.stepX);
    EXPECT_EQ(5964921,
            grid.stepY);  // 5964920.5 and a little, or exactly that if the sine's last place were less
    const Ptr<IIB> iib = rotating(6);
    expectOracle(*iib, texture(grid.image, CV_8U, 5), {keypoint});
}

// Removed regions have a corner outside.
TEST(IIB_Rotated, border_drop_looks_at_the_rotated_region)
{
    const Size size(120, 80);
    const Ptr<IIB> iib = rotating(3);
    iib->setBorder(IIB::BORDER_DROP);
    std::vector<KeyPoint> keypoints;
    for (int i = 0; i < 400; i++)
        keypoints.push_back(KeyPoint(i % 20 * 6.f + 2, i / 20 * 4.f + 2, 15.f, i * 7.f));
    Mat descriptors;
    std::vector<KeyPoint> kept = keypoints;
    iib->compute(texture(size, CV_8U, 1), kept, descriptors);
    ASSERT_GT(kept.size(), 20u);
    ASSERT_LT(kept.size(), keypoints.size());
    for (const KeyPoint& kp : keypoints)
    {
        const double radians = kp.angle * CV_PI / 180,
                     reach = 15 * (std::abs(std::cos(radians)) + std::abs(std::sin(radians)));
        const double gap = std::min(std::min(kp.pt.x + 0.5, size.width - kp.pt.x - 0.5),
                                   std::min(kp.pt.y + 0.5, size.height - kp.pt.y - 0.5)) -
                           reach;
        if (std::abs(gap) > 1e-3)
        {
            const bool found = std::any_of(kept.begin(), kept.end(),
                    [&](const KeyPoint& k) { return k.pt == kp.pt && k.angle == kp.angle; });
            EXPECT_EQ(gap > 0, found) << kp.pt << " " << kp.angle;
        }
    }
}

TEST(IIB_Rotated, whole_turns_change_no_bits)
{
    const Mat image = texture(Size(200, 160), CV_8U, 2);
    const Ptr<IIB> iib = rotating(4, 63);
    const KeyPoint once(100, 80, 30, 30), again(100, 80, 30, 30.f + 360 * 4096);
    const Mat bits = describe(*iib, image, {once, again});
    EXPECT_EQ(0, differingBits(bits.row(0), bits.row(1)));
}

// They differ in step or type.
TEST(IIB_Rotated, maps_that_begin_at_the_same_byte_are_not_the_same)
{
    const Size size(400, 300);
    const Mat memory = texture(Size(2 * size.width, 2 * size.height), CV_8U, 7);
    const Mat even(size, CV_8U, memory.data, size.width), odd(size, CV_8U, memory.data, 2 * size.width),
            wide(size, CV_16U, memory.data, 2 * size.width);
    const Mat image = texture(size, CV_8U, 8);
    const std::vector<KeyPoint> keypoints = {KeyPoint(200, 150, 300, 20)};
    for (const std::vector<Mat>& maps : {std::vector<Mat>{even, odd}, {even, wide}, {odd, wide}})
    {
        const Ptr<IIB> iib = rotating();
        iib->setExtraChannels(2);
        const std::vector<Mat> clones = {maps[0].clone(), maps[1].clone()};
        EXPECT_EQ(0, differingBits(describe(*iib, image, keypoints, clones),
                             describe(*iib, image, keypoints, maps)));
    }
}

// A grid that spans many pixels is read point by point: the bits do not depend on other keypoints.
TEST(IIB_Rotated, sparse_and_dense_grids_give_the_same_bits)
{
    for (int depth : {CV_8U, CV_16U})
    {
        const Mat image = texture(Size(1200, 1000), depth, 3);
        std::vector<Mat> extra;
        for (int i = 0; i < 5; i++)
            extra.push_back(texture(image.size(), i % 2 ? CV_8U : depth, 4 + i));
        const Ptr<IIB> iib = rotating(4, 63);
        iib->setExtraChannels(5);
        std::vector<KeyPoint> keypoints;
        for (int i = 0; i < 3; i++)
            keypoints.push_back(KeyPoint(100.f + 450 * i, 900.f - 380 * i, 500.f, 100.f * i + 9));
        const Mat sparse = describe(*iib, image, keypoints, extra);
        expectOracle(*iib, image, keypoints, extra);
        for (int i = 0; i < 60; i++)
            keypoints.push_back(keypoints[i % 3]);
        EXPECT_EQ(0, differingBits(sparse, describe(*iib, image, keypoints, extra).rowRange(0, 3)));
    }
}

// A few regions may span more pixels than an int counts. Of the image's 2 GB few pages are ever touched.
TEST(IIB_Rotated, area_of_more_than_an_int_of_pixels)
{
    const int side = 46400;
    if ((double)side * side > (double)PTRDIFF_MAX)
        return;  // no object is that large with 32-bit addresses
    const std::unique_ptr<void, void (*)(void*)> memory(calloc(side, side), free);
    if (!memory)
        return;
    Mat image(side, side, CV_8U, memory.get());
    randu(image(Rect(8000, 8000, 500, 500)), 0, 256);
    std::vector<KeyPoint> keypoints;
    for (int i = 0; i < 6; i++)  // neighbours overlap, and all that is between the first and the last counts
        keypoints.push_back(KeyPoint(8200.f + 6000 * i, 8200.f + 6000 * i, 8000, 45));
    const Ptr<IIB> iib = rotating();
    const Mat all = describe(*iib, image, keypoints);
    for (int i = 0; i < (int)keypoints.size(); i += 5)
        EXPECT_EQ(
                0, differingBits(all.row(i), describe(*iib, image, std::vector<KeyPoint>(1, keypoints[i]))));
}

}}  // namespace opencv_test
