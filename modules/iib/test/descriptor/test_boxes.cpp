// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#include "../support/test_errors.hpp"
#include "../support/describe.hpp"

namespace opencv_test { namespace {

const int ALL = IIB::CHANNEL_GRAD_X | IIB::CHANNEL_GRAD_Y | IIB::CHANNEL_INTENSITY |
                IIB::CHANNEL_SIGNED_GRAD_X | IIB::CHANNEL_SIGNED_GRAD_Y;

Ptr<IIB> boxes(int granularity = 5, int channels = ALL)
{
    return IIB::create(1.f, granularity, channels, IIB::MAPPING_BOXES);
}

TEST(IIB_Boxes, bits_as_the_oracle)
{
    for (int depth : {CV_8U, CV_16U})
        for (int granularity = 1; granularity <= 5; granularity++)
            for (int border : {IIB::BORDER_CLAMP, IIB::BORDER_REFLECT})
            {
                SCOPED_TRACE(format("depth %d G %d border %d", depth, granularity, border));
                const Mat image = texture(Size(150, 131), depth, granularity);
                const Ptr<IIB> iib = boxes(granularity);
                iib->setBorder(border);
                expectOracle(*iib, image, scatter(image.size(), 12, 2.f, 120.f, granularity));
            }
}

// The last row and column of an odd image are in squares that reach beyond the image.
TEST(IIB_Boxes, no_pixel_from_outside_counts_when_clamped)
{
    const Mat odd = texture(Size(151, 131), CV_8U, 3), even = odd(Rect(0, 0, 150, 130));
    const std::vector<KeyPoint> keypoints = scatter(odd.size(), 60, 20.f, 120.f, 4);
    for (bool rotated : {false, true})
    {
        const Ptr<IIB> iib = boxes(5, IIB::CHANNEL_INTENSITY);
        iib->setUseOrientation(rotated);
        iib->setBorder(IIB::BORDER_CLAMP);
        EXPECT_EQ(0, differingBits(describe(*iib, odd, keypoints), describe(*iib, even, keypoints)));
        iib->setBorder(IIB::BORDER_REFLECT);
        EXPECT_NE(0, differingBits(describe(*iib, odd, keypoints), describe(*iib, even, keypoints)));
    }
}

// Sums over the largest boxes leave 32 bits in 8-bit images from a side of about 3000 pixels on.
TEST(IIB_Boxes, large_regions)
{
    const Mat image = texture(Size(200, 180), CV_8U, 5);
    std::vector<KeyPoint> keypoints;
    for (float size : {400.f, 2900.f, 3000.f, 20000.f, 1e9f, 1e30f})
        keypoints.push_back(KeyPoint(90.25f, 80.5f, size));
    keypoints.push_back(KeyPoint(1e9f, -1e20f, 60.f));
    for (int border : {IIB::BORDER_CLAMP, IIB::BORDER_REFLECT})
    {
        const Ptr<IIB> iib = boxes(2);
        iib->setBorder(border);
        for (const KeyPoint& kp : keypoints)
            expectOracle(*iib, image, {kp});
        expectOracle(*iib, image, keypoints);
    }
}

// Stripes have the largest gradients at every pixel: their sum over the middle box exceeds 32 bits.
TEST(IIB_Boxes, largest_sums)
{
    Mat image(1500, 1500, CV_8U, Scalar(0));
    for (int x = 2; x < image.cols; x += x % 4 == 2 ? 1 : 3)
        image.col(x).setTo(255);
    const Ptr<IIB> iib = boxes(1);
    iib->setBorder(IIB::BORDER_CLAMP);
    iib->setUseOrientation(true);
    for (float angle : {-1.f, 0.f})
        expectOracle(*iib, image, {KeyPoint(749.5f, 749.5f, 3800.f, angle)});
}

TEST(IIB_Boxes, rotated)
{
    for (int depth : {CV_8U, CV_16U})
        for (int orientation : {IIB::ORIENTATION_KEYPOINT, IIB::ORIENTATION_GRADIENT})
            for (int border : {IIB::BORDER_CLAMP, IIB::BORDER_REFLECT})
            {
                SCOPED_TRACE(format("depth %d, orientation %d, border %d", depth, orientation, border));
                const Mat image = texture(Size(200, 180), depth, 6);
                std::vector<KeyPoint> keypoints = scatter(image.size(), 15, 8.f, 150.f, 7);
                keypoints.push_back(keypoints[3]);  // by ORIENTATION_GRADIENT at another angle
                const Ptr<IIB> iib = boxes();
                iib->setOrientation(orientation);
                iib->setBorder(border);
                expectOracle(*iib, image, keypoints);
            }
}

// Boxes of less than half a pixel.
TEST(IIB_Boxes, rotated_small_regions)
{
    const Mat image = texture(Size(60, 50), CV_8U, 14);
    for (int granularity = 1; granularity <= 5; granularity++)
    {
        SCOPED_TRACE(granularity);
        const Ptr<IIB> iib = boxes(granularity);
        iib->setUseOrientation(true);
        expectOracle(*iib, image, scatter(image.size(), 20, 0.5f, 4.f, granularity));
    }
}

// Boxes reach farthest beyond the region at 45 degrees.
TEST(IIB_Boxes, rotated_large_regions)
{
    const Mat image = texture(Size(700, 640), CV_8U, 11);
    const Ptr<IIB> iib = boxes(2);
    iib->setUseOrientation(true);
    for (float angle : {0.f, 45.f, 225.f})
        expectOracle(*iib, image, {KeyPoint(350.f, 320.f, 420.f, angle)});
}

TEST(IIB_Boxes, rotated_image_has_nearly_the_same_bits)
{
    const RotatedPair pair(35);
    std::vector<KeyPoint> keypoints = scatter(Size(160, 160), 60, 40.f, 60.f, 10), turned;
    for (KeyPoint& kp : keypoints)
    {
        kp.pt += Point2f(120, 120);
        kp.angle = 0;
        const Vec3d p = pair.homography * Vec3d(kp.pt.x, kp.pt.y, 1);
        turned.push_back(KeyPoint((float)p[0], (float)p[1], kp.size, 35));
    }
    const Ptr<IIB> iib = boxes();
    iib->setUseOrientation(true);
    const Mat expected = describe(*iib, pair.images[0], keypoints);
    const int differing = differingBits(expected, describe(*iib, pair.images[1], turned));
    EXPECT_LT(differing, expected.total() * 8 * 0.2);
    for (KeyPoint& kp : turned)
        kp.angle = -1;
    EXPECT_GT(differingBits(expected, describe(*iib, pair.images[1], turned)), 2 * differing);
}

TEST(IIB_Boxes, selections)
{
    const Mat image = texture(Size(300, 280), CV_8U, 8);
    for (int count = 1; count < 400; count *= 3)
    {
        SCOPED_TRACE(count);
        const Ptr<IIB> iib = boxes();
        // of |gx|, |gy|, intensity, gx, gy
        iib->setSelection(randomSelection(count, {2, 4, 6, 8, 6}, {15, 7, 7, 31, 31}));
        expectOracle(*iib, image, scatter(image.size(), 6, 10.f, 200.f, count));
    }
    const Ptr<IIB> last = boxes();
    const Mat single = Mat_<int>({2, 5}, {4, 3, 8, 8, 8, 5, 4, 0, 6, 16});
    last->setSelection(single);
    EXPECT_EQ((std::vector<int>{1, 1}), last->levelSizes());
    expectOracle(*last, image, scatter(image.size(), 6, 10.f, 200.f, 1));
}

TEST(IIB_Boxes, sizes)
{
    // bits of quads 3 * 5 * (n - 1)^2, of boxes 5 n^2
    EXPECT_EQ((std::vector<int>{14, 46, 99, 171, 99}), boxes()->levelSizes());
    EXPECT_EQ((std::vector<int>{2}), boxes(1, IIB::CHANNEL_INTENSITY)->levelSizes());
}

TEST(IIB_Boxes, errors)
{
    expectError(Error::StsOutOfRange, "granularity is 6", [] { boxes(6); });
    expectError(Error::StsBadArg, "CHANNEL_ORIENTATION", [] { boxes(3, IIB::CHANNELS_DEFAULT); });
    expectError(Error::StsBadArg, "extra channels",
            [] { IIB::create(1.f, 3, ALL, IIB::MAPPING_BOXES, false, false, 1); });
    expectError(Error::StsBadArg, "overlap", [] { IIB::create(1.f, 3, ALL, IIB::MAPPING_BOXES, true); });
    const Mat_<int> outside[] = {Mat_<int>({1, 5}, {1, 0, 3, 0, 1}), Mat_<int>({1, 5}, {1, 0, 0, 3, 1}),
            Mat_<int>({1, 5}, {1, 0, 2, 0, 1}), Mat_<int>({1, 5}, {1, 1, 0, 0, 8}),
            Mat_<int>({1, 5}, {1, 0, 0, 0, 16}), Mat_<int>({1, 5}, {1, 0, 0, 0, 0})};
    for (const Mat_<int>& selection : outside)
        expectError(Error::StsOutOfRange, "selection, row 0", [&] { boxes()->setSelection(selection); });
}

}}  // namespace opencv_test
