// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#include "../support/descriptor_oracle.hpp"
#include "../support/describe.hpp"
#include "../support/test_errors.hpp"
#include "../../src/descriptor/kernels/kernels.hpp"

namespace opencv_test { namespace {

TEST(IIB_Orientation, as_atan2_for_all_gradients_of_8_bits)
{
    // Sobel 3x3 of 0..255 lies in -1020..1020. Half a step is lost to rounding.
    const int largest = 4 * 255, turn = cv::iib::ORIENTATION_STEPS;
    double worst = 0;
    for (int gy = -largest; gy <= largest; gy++)
        for (int gx = -largest; gx <= largest; gx++)
        {
            const int steps = oracle::orientation(gx, gy);
            ASSERT_TRUE(steps >= 0 && steps < turn) << gx << ", " << gy;
            const double difference = std::abs(steps - std::atan2(-gy, gx) * turn / (2 * CV_PI));
            worst = std::max(worst, std::min(difference, std::abs(difference - turn)));
        }
    EXPECT_LE(worst, 0.5 + 0.11);
    EXPECT_EQ(0, oracle::orientation(0, 0));
}

// All gradients of 8-bit images: both components are even, or both are odd.
TEST(IIB_Orientation, kernel_for_all_gradients_of_8_bits)
{
    const int largest = 4 * 255, count = largest + 1;
    std::vector<short> above(3 * count + 2 + cv::iib::ROW_PADDING), middle = above, below = above,
                                                                    steps = above;
    for (int gy = -largest; gy <= largest; gy++)
    {
        const int odd = gy & 1;
        for (int i = 0; i < count; i++)
        {
            middle[3 * i + 2] = (short)(i - largest / 2);
            below[3 * i + 1] = (short)((gy - odd) / 2);
            below[3 * i + 2] = (short)odd;
        }
        cv::iib::descriptorKernels().shortPixels.rows.imageChannels(
                {above.data(), middle.data(), below.data()}, 0, {{0, 0, steps.data(), 0, 0, 0}}, 0,
                3 * count);
        for (int i = 0; i < count - odd; i++)
            ASSERT_EQ(oracle::orientation(2 * i - largest + odd, gy), steps[3 * i]) << i << ", " << gy;
    }
}

/* Every value of the rows of channels, sums and cells: 2 x 2 pixels around each pixel, by SORT,
 in all channels, for rows of every width at several alignments. */
TEST(IIB_Orientation, channel_rows_of_every_width_and_alignment)
{
    const int maxWidth = 200, height = 4;
    const Ptr<IIB> iib = IIB::create(1.f, 1, 63, IIB::MAPPING_SORT, false, false, 1);
    for (int depth : {CV_8U, CV_16U})
    {
        // not blurred: the largest gradients too
        const Mat whole = texture(Size(maxWidth + 8, height), depth, depth);
        const Mat map = texture(Size(maxWidth + 8, height), CV_8U, 9);
        for (int width = 1; width <= maxWidth; width++)
        {
            const int left = width % 3 == 0 ? 0 : width % 3 == 1 ? 1 : 7;
            const Mat image = whole.colRange(left, left + width);
            const std::vector<Mat> extra(1, map.colRange(left, left + width));
            std::vector<KeyPoint> keypoints;
            for (int y = 0; y + 1 < height; y++)
                for (int x = 0; x < width; x++)
                    keypoints.push_back(KeyPoint(x + 0.5f, y + 0.5f, 2));
            SCOPED_TRACE(format("width %d alignment %d", width, left));
            expectOracle(*iib, image, keypoints, extra);
        }
    }
}

TEST(IIB_GradientOrientation, modes)
{
    const Ptr<IIB> iib = IIB::create();
    EXPECT_EQ(IIB::ORIENTATION_NONE, iib->getOrientation());
    EXPECT_FALSE(iib->getUseOrientation());
    iib->setUseOrientation(true);
    EXPECT_EQ(IIB::ORIENTATION_KEYPOINT, iib->getOrientation());
    iib->setOrientation(IIB::ORIENTATION_GRADIENT);
    EXPECT_EQ(IIB::ORIENTATION_GRADIENT, iib->getOrientation());
    EXPECT_TRUE(iib->getUseOrientation());
    iib->setUseOrientation(false);
    EXPECT_EQ(IIB::ORIENTATION_NONE, iib->getOrientation());
    EXPECT_EQ(IIB::ORIENTATION_KEYPOINT, IIB::create(2.f, 4, 15, 0, false, true)->getOrientation());
}

TEST(IIB_GradientOrientation, bits_as_the_oracle)
{
    const Size size(200, 170);
    for (int depth : {CV_8U, CV_16U})
    {
        const Mat image = texture(size, depth, 1);
        std::vector<KeyPoint> keypoints = scatter(size, 150, 8.f, 120.f, 2);
        for (int i = 0; i < 40; i++)  // repeated up to three times: they get lower peaks
            keypoints.push_back(keypoints[i % 20]);
        keypoints.insert(keypoints.end(), 40, keypoints[0]);  // more than there are peaks
        for (int granularity : {1, 4, 6})
        {
            const Ptr<IIB> iib = IIB::create(1.f, granularity, 63);
            iib->setOrientation(IIB::ORIENTATION_GRADIENT);
            SCOPED_TRACE(format("depth %d granularity %d", depth, granularity));
            expectOracle(*iib, image, keypoints);
        }
    }
    // with extra channels alone, regions stay upright
    const Ptr<IIB> maps = IIB::create(1.f, 3, 0, IIB::MAPPING_MEAN, false, false, 1);
    const std::vector<Mat> extra(1, texture(size, CV_8U, 3));
    const std::vector<KeyPoint> keypoints = scatter(size, 50, 8.f, 60.f, 4);
    const Mat upright = describe(*maps, extra[0], keypoints, extra);
    maps->setOrientation(IIB::ORIENTATION_GRADIENT);
    EXPECT_EQ(0, differingBits(upright, describe(*maps, extra[0], keypoints, extra)));
}

TEST(IIB_GradientOrientation, keypoints_at_the_same_place_get_different_peaks)
{
    const Mat image = texture(Size(200, 170), CV_8U, 5);
    const Ptr<IIB> iib = IIB::create(1.f);
    iib->setOrientation(IIB::ORIENTATION_GRADIENT);
    const KeyPoint once(90, 80, 60, 10), rotated(90, 80, 60, 200), larger(90, 80, 61, 10);
    const Mat first = describe(*iib, image, {once}), all = describe(*iib, image, {once, rotated, larger});
    EXPECT_EQ(0, differingBits(first, all.row(0)));
    EXPECT_NE(0, differingBits(first, all.row(1)));
    EXPECT_EQ(0, differingBits(describe(*iib, image, {larger}), all.row(2)));
    EXPECT_EQ(0, differingBits(first, describe(*iib, image, {rotated})));  // KeyPoint::angle is ignored
}

TEST(IIB_GradientOrientation, border_drop_keeps_what_is_inside_at_any_angle)
{
    const Mat image = texture(Size(200, 170), CV_8U, 6);
    const Ptr<IIB> iib = IIB::create(1.f);
    iib->setOrientation(IIB::ORIENTATION_GRADIENT);
    iib->setBorder(IIB::BORDER_DROP);
    std::vector<KeyPoint> keypoints = {KeyPoint(28, 80, 40), KeyPoint(27, 80, 40), KeyPoint(100, 80, 40)};
    Mat descriptors;
    iib->compute(image, keypoints, descriptors);  // half the diagonal is 28.3; pixel 28 ends at 28.5
    ASSERT_EQ(2u, keypoints.size());
    EXPECT_EQ(28.f, keypoints[0].pt.x);
    EXPECT_EQ(2, descriptors.rows);
}

TEST(IIB_GradientOrientation, finds_matches_in_a_rotated_image)
{
    RotatedPair pair(40);
    const Ptr<IIB> iib = IIB::create(2.f);
    Mat descriptors[2];
    std::vector<DMatch> matches;
    const Ptr<HierarchicalMatcher> matcher =
            HierarchicalMatcher::create(iib->levelSizes(), HierarchicalMatcher::EXACT, 0.35f, true);
    const auto correct = [&](int orientation) {
        iib->setOrientation(orientation);
        for (int i = 0; i < 2; i++)
            descriptors[i] = describe(*iib, pair.images[i], pair.keypoints[i]);
        matcher->match(descriptors[0], descriptors[1], matches);
        return pair.correct(matches);
    };
    const int upright = correct(IIB::ORIENTATION_NONE);
    const int gradient = correct(IIB::ORIENTATION_GRADIENT);
    const double degrees = estimateRotation(pair.keypoints[0], pair.keypoints[1], matches);
    EXPECT_NEAR(40, degrees, 1);
    for (KeyPoint& kp : pair.keypoints[0])
        kp.angle = 0;
    for (KeyPoint& kp : pair.keypoints[1])
        kp.angle = (float)degrees;
    const int again = correct(IIB::ORIENTATION_KEYPOINT);
    std::cout << format("[          ] correct: upright %d, gradient %d, estimated rotation %d\n", upright,
            gradient, again);
    EXPECT_GE(gradient, 100);
    EXPECT_GE(gradient, 3 * upright);
    EXPECT_GE(again, 1.1 * gradient);
}

TEST(IIB_Rotation, of_positions_with_two_thirds_wrong)
{
    Integers integers(3);
    for (double degrees : {0., 0.4, 30., 179.7, 180., 275.3, 359.8})
    {
        std::vector<KeyPoint> keypoints[2];
        std::vector<DMatch> matches;
        for (int i = 0; i < 300; i++)
        {
            const double x = integers.below(640), y = integers.below(480), radians = degrees * CV_PI / 180;
            keypoints[0].push_back(KeyPoint((float)x, (float)y, 10));
            if (i % 3)
            {
                const int wrongY = integers.below(480), wrongX = integers.below(640);
                keypoints[1].push_back(KeyPoint((float)wrongX, (float)wrongY, 10));
            }
            else
                keypoints[1].push_back(
                        KeyPoint((float)(1.3 * (x * std::cos(radians) - y * std::sin(radians)) + 5),
                                (float)(1.3 * (x * std::sin(radians) + y * std::cos(radians)) - 9), 10));
            matches.push_back(DMatch(i, i, 0));
        }
        const double found = estimateRotation(keypoints[0], keypoints[1], matches);
        EXPECT_GE(found, 0);
        EXPECT_LT(found, 360);
        const double error = std::abs(found - degrees);
        EXPECT_LE(std::min(error, 360 - error), 0.5) << degrees;
    }
}

TEST(IIB_Rotation, errors)
{
    const std::vector<KeyPoint> two = {KeyPoint(1, 2, 3), KeyPoint(4, 5, 6)}, same(2, KeyPoint(1, 1, 1));
    const std::vector<DMatch> both = {DMatch(0, 0, 0), DMatch(1, 1, 0)};
    EXPECT_NEAR(0, estimateRotation(two, two, both), 1e-6);
    for (int i = 0; i < 2; i++)
        for (int index : {-1, 2})
        {
            std::vector<DMatch> broken = both;
            (i ? broken[1].trainIdx : broken[1].queryIdx) = index;
            expectError(
                    Error::StsOutOfRange, format("%d", index), [&] { estimateRotation(two, two, broken); });
        }
    expectError(Error::StsBadArg, "0 matches", [&] { estimateRotation(two, two, std::vector<DMatch>()); });
    expectError(Error::StsBadArg, "1 matches",
            [&] { estimateRotation(two, two, std::vector<DMatch>(1, both[0])); });
    expectError(Error::StsBadArg, "2 matches", [&] { estimateRotation(two, same, both); });
    for (float value : {NOT_A_NUMBER, ENDLESS, -ENDLESS})
    {
        std::vector<KeyPoint> broken = two;
        broken[1].pt.y = value;
        expectError(Error::StsBadArg, "keypoint 1", [&] { estimateRotation(broken, two, both); });
        expectError(Error::StsBadArg, "keypoint 1", [&] { estimateRotation(two, broken, both); });
    }
}

}}  // namespace opencv_test
