// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#include "../support/test_images.hpp"

namespace opencv_test {
namespace {

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

// The samples fall on the same pixels, and the gradient rotates exactly; where there is none, nothing rotates.
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
            // and it is the angle that does it
            for (KeyPoint& kp : rotated)
                kp.angle = std::fmod(kp.angle + 90, 360.f);
            EXPECT_GT(differingBits(expected, describe(*iib, rotatedImage, rotated)),
                    0.2 * 8 * expected.total());
        }
    }
}

}  // namespace
}  // namespace opencv_test
