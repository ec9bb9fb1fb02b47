// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#include "../support/test_images.hpp"
#include "normalization_oracle.hpp"
#include "seen_image.hpp"

namespace opencv_test { namespace {

void expectOracle(const Mat& image, float sigma)
{
    ASSERT_EQ(0, differingBits(oracle::normalizeLocally(image, sigma), normalized(image, sigma)))
            << image.size() << ", sigma " << sigma;
}

TEST(IIB_Normalization, as_the_oracle_for_every_size_and_alignment)
{
    const Mat whole = texture(Size(220, 40), CV_8U, 1);
    for (int width = 1; width <= 200; width += width < 70 ? 1 : 13)
    {
        const int left = width % 3 == 0 ? 0 : width % 3 == 1 ? 1 : 7;
        expectOracle(whole(Rect(left, width % 3, width, 1 + width % 37)), 4);
    }
}

TEST(IIB_Normalization, as_the_oracle_for_every_sigma_and_depth)
{
    for (int depth : {CV_8U, CV_16U})
    {
        const Mat image = texture(Size(150, 97), depth, 2);
        for (float sigma : {1.f, 1.3f, 1.99f, 2.f, 3.f, 4.f, 5.5f, 8.f, 20.f, 100.f, 256.f})
            expectOracle(image, sigma);
    }
}

// Black and white pixels: the largest differences and variances.
TEST(IIB_Normalization, as_the_oracle_at_the_largest_contrast)
{
    Mat image = texture(Size(130, 70), CV_8U, 3);
    cv::threshold(image, image, 127, 255, THRESH_BINARY);
    for (float sigma : {1.f, 2.f, 4.f, 9.f})
        expectOracle(image, sigma);
    Mat point(64, 64, CV_8U, Scalar(0));
    point.at<uchar>(30, 30) = 255;
    expectOracle(point, 4);
    expectOracle(255 - point, 4);
}

TEST(IIB_Normalization, is_near_its_definition)
{
    const Mat image = relit(scene(Size(320, 240), 5), 6);
    for (float sigma : {2.f, 3.f, 4.f, 6.f, 8.f, 16.f})
    {
        const Mat expected = oracle::normalizeByDefinition(image, sigma), actual = normalized(image, sigma);
        const double error = cvtest::norm(expected, actual, NORM_L1) / image.total();
        std::cout << format("[          ] sigma %g: mean difference %.2f of 255\n", sigma, error);
        EXPECT_LE(error, 1.6) << sigma;
    }
}

TEST(IIB_Normalization, flat_images_are_grey)
{
    for (int grey : {0, 77, 255})
        EXPECT_EQ(0, cvtest::norm(normalized(Mat(50, 60, CV_8U, Scalar(grey)), 4.f),
                             Mat(50, 60, CV_8U, Scalar(128)), NORM_INF));
    EXPECT_EQ(0, cvtest::norm(normalized(Mat(50, 60, CV_16U, Scalar(0)), 4.f),
                         Mat(50, 60, CV_8U, Scalar(128)), NORM_INF));
}

TEST(IIB_Normalization, does_not_depend_on_how_pixels_are_stored)
{
    Mat image = texture(Size(90, 70), CV_8U, 4), other;
    image.at<uchar>(3, 3) = 255;
    image.at<uchar>(40, 50) = 0;
    const Mat expected = normalized(image, 4.f);
    for (double scale : {1., 16., 257.})
    {
        image.convertTo(other, CV_16U, scale);
        EXPECT_EQ(0, differingBits(expected, normalized(other, 4.f))) << scale;
    }
    image.convertTo(other, CV_32F, 1. / 255, -3);
    EXPECT_LE(cvtest::norm(expected, normalized(other, 4.f), NORM_INF), 1);
    for (int code : {COLOR_GRAY2BGR, COLOR_GRAY2BGRA})
    {
        cvtColor(image, other, code);
        EXPECT_EQ(0, differingBits(expected, normalized(other, 4.f)));
    }
    EXPECT_EQ(0, differingBits(expected, normalized(image.getUMat(ACCESS_READ), 4.f)));
}

// Exact pixels, on every build and machine.
TEST(IIB_Normalization, golden_hash)
{
    const Mat image = normalized(texture(Size(321, 243), CV_8U, 1), 4.f);
    EXPECT_EQ(CV_BIG_UINT(0xa3599b23675f00b3), hashOf(image)) << std::hex << hashOf(image);
}

}}  // namespace opencv_test
