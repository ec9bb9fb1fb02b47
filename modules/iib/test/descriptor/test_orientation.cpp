// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#include "../support/descriptor_oracle.hpp"
#include "../support/test_images.hpp"

#include "../../src/descriptor/kernels/kernels.hpp"

namespace opencv_test {
namespace {

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

// Every gradient that an 8-bit image can have, by this machine's kernel: both components are even, or both are odd.
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
                {above.data(), middle.data(), below.data()}, 0, {0, 0, 0, 0, 0, steps.data()}, 0, 3 * count);
        for (int i = 0; i < count - odd; i++)
            ASSERT_EQ(oracle::orientation(2 * i - largest + odd, gy), steps[3 * i]) << i << ", " << gy;
    }
}

/* Every value of the rows of channels, sums and cells: two by two pixels around each pixel, whose order SORT tells,
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

}  // namespace
}  // namespace opencv_test
