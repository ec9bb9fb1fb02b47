// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#include "../support/test_images.hpp"
#include "../normalization/normalization_oracle.hpp"
#include "hessian_oracle.hpp"

namespace opencv_test { namespace {

TEST(IIB_HessianDetector, as_the_oracle_for_every_size_and_alignment)
{
    const Mat whole = texture(Size(260, 70), CV_8U, 1);
    const Ptr<HessianDetector> detector = HessianDetector::create(0);
    size_t n = 0;
    for (int width = 2; width <= 240; width += width < 90 ? 1 : 13)
    {
        const Mat image = whole(Rect(width % 5, width % 3, width, 2 + width % 61));
        const std::vector<KeyPoint> expected = oracle::findBlobs(image, *detector);
        expectSameKeyPoints(expected, found(*detector, image));
        ASSERT_FALSE(HasFailure()) << image.size();
        n += expected.size();
    }
    EXPECT_GT(n, 1000u);
}

TEST(IIB_HessianDetector, as_the_oracle_for_every_parameter_and_depth)
{
    struct
    {
        int maxFeatures;
        float threshold;
        int scales;
        float sigma, normalizationSigma;
    } const all[] = {{0, 0, 5, 2, 4}, {50, 0, 5, 2.2f, 5}, {0, .05f, 5, 2, 4}, {0, 0, 1, 2, 4},
            {0, 0, 2, 1.5f, 2}, {0, 0, 8, 1.5f, 3}, {0, 0, 3, 2.5f, 5}, {0, 0, 4, 3.3f, 20},
            {0, 0, 8, 8, 256}, {0, 0, 6, 4, 6}};
    for (int depth : {CV_8U, CV_16U})
        for (const auto& p : all)
        {
            const Mat image = texture(Size(187, 131), depth, 2);
            const Ptr<HessianDetector> detector = HessianDetector::create(
                    p.maxFeatures, p.threshold, p.scales, p.sigma, p.normalizationSigma);
            expectSameKeyPoints(oracle::findBlobs(image, *detector), found(*detector, image));
            ASSERT_FALSE(HasFailure()) << depth << ": " << p.maxFeatures << " " << p.threshold << " "
                                       << p.scales << " " << p.sigma << " " << p.normalizationSigma;
        }
}

// Black and white pixels, and a pattern that repeats: the largest numbers, and neighbours with the same response.
TEST(IIB_HessianDetector, as_the_oracle_at_the_largest_contrast_and_with_ties)
{
    Mat noise = texture(Size(130, 90), CV_8U, 3);
    cv::threshold(noise, noise, 127, 255, THRESH_BINARY);
    Mat pattern(120, 160, CV_8U);
    for (int y = 0; y < pattern.rows; y++)
        for (int x = 0; x < pattern.cols; x++)
            pattern.at<uchar>(y, x) = (x / 8 + y / 8) % 2 ? 255 : 0;
    const Ptr<HessianDetector> detector = HessianDetector::create(0);
    for (const Mat& image : {noise, pattern, Mat(255 - pattern)})
    {
        const std::vector<KeyPoint> expected = oracle::findBlobs(image, *detector);
        EXPECT_GT(expected.size(), 50u);
        expectSameKeyPoints(expected, found(*detector, image));
    }
}

TEST(IIB_HessianDetector, the_same_for_every_number_of_threads)
{
    const Mat image = texture(Size(300, 421), CV_8U, 4);
    const Ptr<HessianDetector> detector = HessianDetector::create(0);
    EXPECT_GT(found(*detector, image).size(), 500u);
    forEveryNumberOfThreads([&] { return found(*detector, image); }, expectSameKeyPoints);
}

TEST(IIB_HessianDetector, finds_a_blob_where_it_is_and_how_large)
{
    const Ptr<HessianDetector> detector = HessianDetector::create(1, 0.f, 6, 2.f, 256.f);
    float sizeOfFour = 0;  // larger than 8: local normalization raises the flanks of a blob on a plain ground
    for (double sigma : {4., 3., 5.5})
        for (const Point2d centre : {Point2d(60, 50), Point2d(60.5, 50.25), Point2d(61.3, 49.7)})
        {
            Mat image(100, 120, CV_32F);
            for (int y = 0; y < image.rows; y++)
                for (int x = 0; x < image.cols; x++)
                    image.at<float>(y, x) = (float)std::exp(
                            -(std::pow(x - centre.x, 2) + std::pow(y - centre.y, 2)) / (2 * sigma * sigma));
            for (const Mat& blob : {image, Mat(-image)})
            {
                const std::vector<KeyPoint> keypoints = found(*detector, blob);
                ASSERT_EQ(1u, keypoints.size());
                EXPECT_NEAR(centre.x, keypoints[0].pt.x, .15) << sigma;
                EXPECT_NEAR(centre.y, keypoints[0].pt.y, .15) << sigma;
                if (sizeOfFour == 0)
                    sizeOfFour = keypoints[0].size;
                EXPECT_NEAR(2 * (sigma - 4), keypoints[0].size - sizeOfFour, .8);
                EXPECT_EQ(-1.f, keypoints[0].angle);
            }
        }
}

// for comparison, SIFT: .96 within a quarter of a pixel, .98 within 1.5 pixels
TEST(IIB_HessianDetector, keypoints_move_with_the_picture)
{
    const Mat image = relit(scene(Size(520, 400), 9), 10);
    const Size window(512, 392);
    const Ptr<HessianDetector> detector = HessianDetector::create(500);
    const std::vector<KeyPoint> first = found(*detector, image(Rect(Point(), window)));
    for (const Point& shift : {Point(1, 0), Point(1, 1), Point(3, 5)})
    {
        const std::vector<KeyPoint> second = found(*detector, image(Rect(shift, window)));
        int all = 0, within = 0, near = 0;
        for (const KeyPoint& kp : first)
        {
            const Point2f expected = kp.pt - Point2f(shift);
            if (!Rect(24, 24, window.width - 48, window.height - 48).contains(Point(expected)))
                continue;
            double distance = 1e9;
            for (const KeyPoint& other : second)
                distance = std::min(distance, cv::norm(other.pt - expected));
            all++;
            within += distance < .25;
            near += distance < 1.5;
        }
        EXPECT_GE(within, .9 * all) << shift;
        EXPECT_GE(near, .96 * all) << shift;
    }
}

// 8-bit pixels, differences for derivatives, integer weights and half the resolution for large blobs change little.
TEST(IIB_HessianDetector, keypoints_are_near_their_definition)
{
    std::vector<double> ratios;  // of responses
    // The share of `some` that have one of the same scale among `others`, at most 1.5 pixels away.
    const auto shareNear = [&](const std::vector<KeyPoint>& some, const std::vector<KeyPoint>& others) {
        size_t count = 0;
        for (const KeyPoint& kp : some)
            for (const KeyPoint& other : others)
                if (other.octave == kp.octave && cv::norm(other.pt - kp.pt) < 1.5)
                {
                    count++;
                    ratios.push_back(kp.response / other.response);
                    EXPECT_NEAR(1, kp.size / other.size, .2);
                    break;
                }
        return (double)count / some.size();
    };
    for (int seed : {11, 13, 15})
    {
        const Mat image = relit(scene(Size(320, 240), seed), seed + 1);
        const Ptr<HessianDetector> detector = HessianDetector::create(300);
        std::vector<KeyPoint> defined = oracle::blobsByDefinition(image, *detector);
        const std::vector<KeyPoint> strongest = found(*detector, image);
        ASSERT_EQ(300u, strongest.size());
        EXPECT_GE(shareNear(strongest, defined), .88);
        KeyPointsFilter::runByImageBorder(defined, image.size(), 24);
        KeyPointsFilter::retainBest(defined, 200);
        EXPECT_GE(shareNear(defined, found(*HessianDetector::create(0), image)), .85);
    }
    std::sort(ratios.begin(), ratios.end());
    const auto ratioAt = [&](double share) { return ratios[(size_t)(share * ratios.size())]; };
    std::cout << format("[          ] responses over their definition: %.2f, %.2f, %.2f\n", ratioAt(.05),
            ratioAt(.5), ratioAt(.95));
    EXPECT_GE(ratioAt(.05), .78);
    EXPECT_NEAR(1, ratioAt(.5), .06);
    EXPECT_LE(ratioAt(.95), 1.3);
}

// 700 pixels to at most 240: a third.
TEST(IIB_HessianDetector, large_images_are_searched_at_the_working_size)
{
    for (int depth : {CV_8U, CV_16U})
    {
        const Mat image = texture(Size(700, 502), depth, 13);
        Mat third(Size(233, 167), image.type());
        for (int y = 0; y < third.rows; y++)
            for (int x = 0; x < third.cols; x++)
            {
                const double mean = cv::mean(image(Rect(3 * x, 3 * y, 3, 3)))[0];
                if (depth == CV_8U)
                    third.at<uchar>(y, x) = (uchar)cvFloor(mean + .5);
                else
                    third.at<ushort>(y, x) = (ushort)cvFloor(mean + .5);
            }
        std::vector<KeyPoint> expected = found(*HessianDetector::create(0), third);
        EXPECT_GT(expected.size(), 200u);
        for (KeyPoint& kp : expected)
        {
            kp.pt = 3.f * kp.pt + Point2f(1, 1);
            kp.size *= 3;
        }
        const Ptr<HessianDetector> detector = HessianDetector::create(0, 0.f, 5, 2.2f, 5.f, 240);
        expectSameKeyPoints(expected, found(*detector, image));
        Mat mask = Mat::zeros(image.size(), CV_8U);
        mask.colRange(0, 350) = 255;
        expected.erase(std::remove_if(expected.begin(), expected.end(),
                               [](const KeyPoint& kp) { return cvRound(kp.pt.x) >= 350; }),
                expected.end());
        expectSameKeyPoints(expected, found(*detector, image, mask));
        detector->setWorkingSize(0);
        expectSameKeyPoints(found(*HessianDetector::create(0), image), found(*detector, image));
    }
}

// Reduced by their longer side alone, they would vanish.
TEST(IIB_HessianDetector, long_and_narrow_images_have_keypoints)
{
    const Ptr<HessianDetector> detector = HessianDetector::create(0, 0, 5, 2.2f, 5, 64);
    const Mat image = texture(Size(2000, 40), CV_8U, 7);
    detector->setWorkingSize(0);
    const std::vector<KeyPoint> whole = found(*detector, image);
    EXPECT_GT(whole.size(), 100u);
    detector->setWorkingSize(64);  // a quarter of it is in the shorter side twice
    EXPECT_GT(found(*detector, image).size(), 10u);
    detector->setWorkingSize(160);
    expectSameKeyPoints(whole, found(*detector, image));
}

TEST(IIB_HessianDetector, strongest_first_and_fewer_are_the_first_of_more)
{
    const Mat image = texture(Size(320, 240), CV_8U, 5);
    const std::vector<KeyPoint> all = found(*HessianDetector::create(0), image);
    ASSERT_GT(all.size(), 600u);
    for (size_t i = 1; i < all.size(); i++)
        EXPECT_GE(all[i - 1].response, all[i].response);
    const std::vector<KeyPoint> some = found(*HessianDetector::create(100), image);
    expectSameKeyPoints(std::vector<KeyPoint>(all.begin(), all.begin() + 100), some);
    const float threshold = all[200].response;
    for (const KeyPoint& kp : found(*HessianDetector::create(0, threshold), image))
        EXPECT_GE(kp.response, threshold);
    EXPECT_EQ(201u, found(*HessianDetector::create(0, threshold), image).size());
}

}}  // namespace opencv_test
