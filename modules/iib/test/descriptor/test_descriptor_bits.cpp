// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#include "../support/describe.hpp"

namespace opencv_test { namespace {

typedef testing::TestWithParam<int> IIB_Bits_Mapping;

TEST_P(IIB_Bits_Mapping, as_the_equations)
{
    const Mat image = texture(Size(150, 131), CV_8U, 1);
    for (int granularity = 1; granularity <= 6; granularity++)
        for (int overlap = 0; overlap < 2; overlap++)
        {
            SCOPED_TRACE(format("G %d overlap %d", granularity, overlap));
            const Ptr<IIB> iib =
                    IIB::create(2.f, granularity, IIB::CHANNELS_DEFAULT, GetParam(), overlap != 0);
            expectOracle(*iib, image, scatter(image.size(), 12, 1.f, 60.f, granularity));
        }
}

INSTANTIATE_TEST_CASE_P(
        /**/, IIB_Bits_Mapping, testing::Range((int)IIB::MAPPING_MEAN, (int)IIB::MAPPING_PAIRWISE + 1));

TEST(IIB_Bits, every_set_of_channels)
{
    const Mat image = texture(Size(101, 97), CV_8U, 2);
    for (int channels = 1; channels < 64; channels++)
    {
        SCOPED_TRACE(channels);
        expectOracle(*IIB::create(1.f, 3, channels), image, scatter(image.size(), 10, 8.f, 70.f, channels));
        if ((channels & IIB::CHANNEL_ORIENTATION) == 0)
            expectOracle(*IIB::create(1.f, 2, channels, IIB::MAPPING_BOXES), image,
                    scatter(image.size(), 4, 8.f, 70.f, channels));
    }
}

TEST(IIB_Bits, extra_channels_of_any_depth)
{
    for (int depth = 0; depth < 2; depth++)
        for (int count = 1; count <= 6; count++)
        {
            const Mat image = texture(Size(90, 83), depth ? CV_16U : CV_8U, 3);
            std::vector<Mat> extra;
            for (int i = 0; i < count; i++)
                extra.push_back(texture(image.size(), i % 2 ? CV_16U : CV_8U, 10 + i));
            for (int channels = 0; channels < 16; channels += 5)
            {
                SCOPED_TRACE(format("depth %d channels %d extra %d", depth, channels, count));
                const Ptr<IIB> iib = IIB::create(1.f, 4, channels, IIB::MAPPING_HAAR, false, false, count);
                expectOracle(*iib, image, scatter(image.size(), 10, 10.f, 90.f, count), extra);
            }
        }
}

TEST(IIB_Bits, images_of_every_width)
{
    const Ptr<IIB> quads = IIB::create(1.f, 3),
                   boxes = IIB::create(1.f, 4, 63 - IIB::CHANNEL_ORIENTATION, IIB::MAPPING_BOXES);
    for (int width = 1; width < 140; width++)
        for (int orientation = IIB::ORIENTATION_NONE; orientation <= IIB::ORIENTATION_GRADIENT; orientation++)
        {
            SCOPED_TRACE(format("width %d, orientation %d", width, orientation));
            const Mat image = texture(Size(width, 1 + (width - 1) % 23), CV_8U, width);
            quads->setOrientation(orientation);
            expectOracle(*quads, image, scatter(image.size(), 6, 4.f, 50.f, width));
            boxes->setBorder(width % 2 ? IIB::BORDER_CLAMP : IIB::BORDER_REFLECT);
            if (orientation == IIB::ORIENTATION_NONE)
                expectOracle(*boxes, image, scatter(image.size(), 3, 4.f, 50.f, width));
        }
}

TEST(IIB_Bits, large_regions_of_support)
{
    const Mat image = texture(Size(700, 640), CV_8U, 5);
    for (int granularity = 1; granularity <= 5; granularity += 2)
    {
        SCOPED_TRACE(granularity);
        const Ptr<IIB> iib = IIB::create(1.f, granularity, 63);
        expectOracle(*iib, image, scatter(image.size(), 6, 100.f, 900.f, granularity));
    }
}

// The region of FAST's keypoints is a little wider than 64 pixels: 15 columns of cells have 4 of them, one has 5.
TEST(IIB_Bits, cells_of_four_pixels_and_of_five)
{
    const Mat image = texture(Size(150, 131), CV_8U, 9);
    for (int granularity : {4, 5})
        expectOracle(*IIB::create(IIB::scaleFactorFor("FAST"), granularity), image,
                {KeyPoint(40, 60, 7), KeyPoint(71, 50, 7), KeyPoint(90, 75.5f, 14), KeyPoint(60, 65, 14)});
}

// Sums of 16-bit pixels exceed 32 bits: cells are added up from parts.
TEST(IIB_Bits, large_regions_of_16_bit_images)
{
    const Mat image = texture(Size(420, 400), CV_16U, 5);
    const Ptr<IIB> iib = IIB::create(1.f, 1, 63);
    expectOracle(*iib, image, scatter(image.size(), 6, 300.f, 1500.f, 1));
}

// Products of level 1 or 2 just exceed 32 bits.
TEST(IIB_Bits, sums_at_the_edge_of_32_bits)
{
    for (int mapping = IIB::MAPPING_MEAN; mapping <= IIB::MAPPING_PAIRWISE; mapping++)
        for (int depth : {CV_8U, CV_16U})
        {
            SCOPED_TRACE(mapping);
            Mat image = texture(Size(260, 240), depth, mapping);
            image.colRange(130, 260).setTo(0);  // sums of all sizes
            const Ptr<IIB> iib = IIB::create(1.f, 3, 63, mapping);
            std::vector<KeyPoint> keypoints;
            for (float size : {13.f, 27.f, 45.f, 67.f, 81.f, 103.f, 133.f, 201.f})
                for (int i = 0; i < 3; i++)
                    keypoints.push_back(KeyPoint(100.25f + 30 * i, 90.75f + 20 * i, size));
            expectOracle(*iib, image, keypoints);
        }
}

TEST(IIB_Bits, selections)
{
    const Mat image = texture(Size(300, 280), CV_8U, 8);
    for (int mapping = 0; mapping <= IIB::MAPPING_PAIRWISE; mapping++)
        for (int count = 1; count < 400; count *= 3)
        {
            SCOPED_TRACE(format("mapping %d, %d quads", mapping, count));
            const Ptr<IIB> iib = IIB::create(1.f, 5, 63, mapping);
            const int bits[] = {4, 4, 4, 8, 8, 3, 4};
            iib->setSelection(
                    randomSelection(count, {1, 3, 7, 15, 31}, std::vector<int>(6, (1 << bits[mapping]) - 1)));
            expectOracle(*iib, image, scatter(image.size(), 10, 10.f, 400.f, mapping));
        }
}

TEST(IIB_Bits, rotated_regions_of_support)
{
    for (int depth = 0; depth < 2; depth++)
        for (int granularity = 1; granularity <= 6; granularity++)
        {
            SCOPED_TRACE(format("depth %d G %d", depth, granularity));
            const Mat image = texture(Size(200, 180), depth ? CV_16U : CV_8U, 6);
            const std::vector<Mat> extra(2, texture(image.size(), CV_8U, 7));
            const Ptr<IIB> iib =
                    IIB::create(1.f, granularity, 63, granularity, granularity % 2 == 0, true, 2);
            expectOracle(*iib, image, scatter(image.size(), 10, 8.f, 200.f, granularity), extra);
            iib->setChannels(0);
            expectOracle(*iib, image, scatter(image.size(), 5, 8.f, 200.f, granularity), extra);
        }
}

const Size SIZE(180, 160);
const int GRADIENTS_AND_INTENSITY = IIB::CHANNEL_GRAD_X | IIB::CHANNEL_GRAD_Y | IIB::CHANNEL_INTENSITY |
                                    IIB::CHANNEL_SIGNED_GRAD_X | IIB::CHANNEL_SIGNED_GRAD_Y;
const int ALL_CHANNELS = GRADIENTS_AND_INTENSITY | IIB::CHANNEL_ORIENTATION;

typedef testing::TestWithParam<int> IIB_Property_Mapping;

TEST_P(IIB_Property_Mapping, coarser_descriptor_is_a_prefix)
{
    const Mat image = texture(SIZE, CV_8U, 1);
    const std::vector<KeyPoint> keypoints = scatter(SIZE, 30, 65.f, 120.f, 2);
    for (int rotated = 0; rotated < 2; rotated++)
        for (int overlap = 0; overlap < 2; overlap++)
        {
            const Ptr<IIB> iib = IIB::create(1.f, 6, ALL_CHANNELS, GetParam(), overlap != 0, rotated != 0);
            const Mat fine = describe(*iib, image, keypoints);
            const std::vector<int> sizes = iib->levelSizes();
            ASSERT_EQ(6u, sizes.size());
            for (int granularity = 5; granularity >= 1; granularity--)
            {
                iib->setGranularity(granularity);
                EXPECT_EQ(std::vector<int>(sizes.begin(), sizes.begin() + granularity), iib->levelSizes());
                const Mat coarse = describe(*iib, image, keypoints);
                EXPECT_EQ(0, differingBits(coarse, fine.colRange(0, coarse.cols)))
                        << "G " << granularity << " overlap " << overlap << " rotated " << rotated;
            }
        }
}

INSTANTIATE_TEST_CASE_P(
        /**/, IIB_Property_Mapping, testing::Range((int)IIB::MAPPING_MEAN, (int)IIB::MAPPING_PAIRWISE + 1));

TEST(IIB_Property, linear_illumination_changes_no_bit)
{
    Mat image = texture(SIZE, CV_8U, 3);
    image.at<uchar>(0, 0) = 0;
    image.at<uchar>(5, 7) = 255;
    const std::vector<KeyPoint> keypoints = scatter(SIZE, 60, 8.f, 90.f, 4);
    const double illumination[][2] = {{1, 0}, {2, 16}, {0.5, -100}, {1. / 1024, 0}, {7.25, 0.5},
            {1. / 3, 17.3}, {0.1, -0.7}, {1e-3, 0}, {1e6, 1e6}, {1e-12, 0}};
    for (int mapping = IIB::MAPPING_MEAN; mapping <= IIB::MAPPING_PAIRWISE; mapping++)
    {
        const Ptr<IIB> iib = IIB::create(1.f, 4, GRADIENTS_AND_INTENSITY, mapping);
        const Mat expected = describe(*iib, image, keypoints);
        ASSERT_NE(0, differingBits(expected, Mat::zeros(expected.size(), CV_8U)));
        for (const double* l : illumination)
        {
            Mat lit;
            image.convertTo(lit, CV_32F, l[0], l[1]);
            EXPECT_EQ(0, differingBits(expected, describe(*iib, lit, keypoints)))
                    << "mapping " << mapping << ", " << l[0] << " * I + " << l[1];
        }
    }
}

// The samples fall on the same pixels, and the gradient rotates exactly; a zero gradient does not rotate.
TEST(IIB_Property, rotated_with_the_image)
{
    const Mat image = texture(SIZE, CV_8U, 7);
    const std::vector<KeyPoint> keypoints = scatter(SIZE, 100, 20.f, 60.f, 8);
    for (int channels : {GRADIENTS_AND_INTENSITY, (int)IIB::CHANNELS_DEFAULT})
    {
        const Ptr<IIB> iib = IIB::create(1.f, 4, channels, IIB::MAPPING_MEAN, false, true);
        std::vector<KeyPoint> inside;
        for (KeyPoint kp : keypoints)
            if (Rect2f(45, 45, SIZE.width - 90.f, SIZE.height - 90.f).contains(kp.pt))
            {
                kp.angle = std::max(kp.angle, 0.f);
                inside.push_back(kp);
            }
        ASSERT_GT(inside.size(), 10u);
        const Mat expected = describe(*iib, image, inside);
        for (int quarters = 1; quarters < 4; quarters++)
        {
            Mat rotatedImage;
            cv::rotate(image, rotatedImage, quarters - 1);  // clockwise by 90, 180, 270 degrees
            std::vector<KeyPoint> rotated = inside;
            for (KeyPoint& kp : rotated)
            {
                const Point2f p = kp.pt;
                const float right = SIZE.width - 1.f, bottom = SIZE.height - 1.f;
                kp.pt = quarters == 1   ? Point2f(bottom - p.y, p.x)
                        : quarters == 2 ? Point2f(right - p.x, bottom - p.y)
                                        : Point2f(p.y, right - p.x);
                kp.angle = std::fmod(kp.angle + 90 * quarters, 360.f);
            }
            const int bits = differingBits(expected, describe(*iib, rotatedImage, rotated));
            EXPECT_EQ(0, bits);
            // with wrong angles, bits differ
            for (KeyPoint& kp : rotated)
                kp.angle = std::fmod(kp.angle + 90, 360.f);
            EXPECT_GT(differingBits(expected, describe(*iib, rotatedImage, rotated)),
                    0.2 * 8 * expected.total());
        }
    }
}

}}  // namespace opencv_test
