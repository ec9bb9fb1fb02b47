// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#include "../support/temporary_file.hpp"
#include "../support/test_errors.hpp"
#include "../support/textures.hpp"

namespace opencv_test { namespace {

TEST(IIB_HessianDetector, takes_every_type_of_image)
{
    const Mat grey = texture(Size(200, 160), CV_8U, 6);
    const Ptr<HessianDetector> detector = HessianDetector::create();
    const std::vector<KeyPoint> expected = found(*detector, grey);
    ASSERT_GT(expected.size(), 100u);
    Mat colour, framed;
    for (int channels : {3, 4})
    {
        merge(std::vector<Mat>(channels, grey), colour);
        expectSameKeyPoints(expected, found(*detector, colour));
    }
    UMat onDevice;
    grey.copyTo(onDevice);
    expectSameKeyPoints(expected, found(*detector, onDevice));
    cv::copyMakeBorder(grey, framed, 5, 6, 7, 8, BORDER_CONSTANT, Scalar(0));
    expectSameKeyPoints(expected, found(*detector, framed(Rect(Point(7, 5), grey.size()))));
    Mat wide, real;
    grey.convertTo(wide, CV_16U, 257);
    grey.convertTo(real, CV_32F, 1 / 255.);
    for (const Mat& image : {wide, real})
        EXPECT_GT(found(*detector, image).size(), 100u);
    EXPECT_TRUE(found(*detector, Mat()).empty());
    EXPECT_TRUE(found(*detector, Mat(1, 40, CV_8U, Scalar(7))).empty());
    EXPECT_TRUE(found(*detector, Mat(90, 90, CV_8U, Scalar(7))).empty());
}

TEST(IIB_HessianDetector, masks_leave_out_before_the_strongest_are_chosen)
{
    const Mat image = texture(Size(240, 200), CV_8U, 7);
    Mat mask = Mat::zeros(image.size(), CV_8U);
    mask(Rect(30, 40, 100, 120)) = 1;
    std::vector<KeyPoint> expected;
    for (const KeyPoint& kp : found(*HessianDetector::create(0), image))
        if (mask.at<uchar>(cvRound(kp.pt.y), cvRound(kp.pt.x)))
            expected.push_back(kp);
    ASSERT_GT(expected.size(), 60u);
    expected.resize(60);
    const Ptr<HessianDetector> detector = HessianDetector::create(60);
    expectSameKeyPoints(expected, found(*detector, image, mask));
    expectError(Error::StsUnmatchedSizes, "mask", [&] { found(*detector, image, mask.rowRange(0, 50)); });
    expectError(Error::StsUnsupportedFormat, "mask",
            [&] { found(*detector, image, Mat(image.size(), CV_32F, Scalar(1))); });
}

TEST(IIB_HessianDetector, errors)
{
    expectError(Error::StsOutOfRange, "maxFeatures", [] { HessianDetector::create(-1); });
    for (float threshold : {-.1f, NOT_A_NUMBER, ENDLESS})
        expectError(Error::StsOutOfRange, "threshold", [&] { HessianDetector::create(1, threshold); });
    for (int scales : {0, 9})
        expectError(Error::StsOutOfRange, "scales", [&] { HessianDetector::create(1, 0.f, scales); });
    for (float sigma : {1.49f, 8.1f, NOT_A_NUMBER})
        expectError(Error::StsOutOfRange, "sigma", [&] { HessianDetector::create(1, 0.f, 5, sigma); });
    for (float sigma : {1.9f, 257.f, NOT_A_NUMBER})
        expectError(Error::StsOutOfRange, "normalizationSigma",
                [&] { HessianDetector::create(1, 0.f, 5, 2.f, sigma); });
    for (int size : {-1, 63})
        expectError(Error::StsOutOfRange, "workingSize",
                [&] { HessianDetector::create(1, 0.f, 5, 2.f, 5.f, size); });
    const Ptr<HessianDetector> detector = HessianDetector::create();
    expectError(Error::StsOutOfRange, "sigma", [&] { detector->setSigma(0); });
    expectError(Error::StsOutOfRange, "scales", [&] { detector->setScales(0); });
    EXPECT_EQ(HessianDetector::create()->getSigma(), detector->getSigma());
    expectError(Error::StsBadArg, "2 channels", [&] { found(*detector, Mat(30, 30, CV_8UC2)); });
    Mat broken = Mat::zeros(30, 30, CV_32F);
    broken.at<float>(7, 9) = NOT_A_NUMBER;
    expectError(Error::StsBadArg, "(9, 7)", [&] { found(*detector, broken); });
    std::vector<KeyPoint> keypoints(1, KeyPoint(9, 9, 5));
    Mat descriptors;
    const Mat image = texture(Size(60, 60), CV_8U, 8);
    expectError(
            Error::StsNotImplemented, "createFor", [&] { detector->compute(image, keypoints, descriptors); });
    expectError(Error::StsNotImplemented, "createFor",
            [&] { detector->detectAndCompute(image, noArray(), keypoints, descriptors); });
    detector->detectAndCompute(image, noArray(), keypoints, noArray());
    expectSameKeyPoints(found(*detector, image), keypoints);
}

TEST(IIB_HessianDetector, parameters_and_files)
{
    const Ptr<HessianDetector> detector = HessianDetector::create();
    detector->setMaxFeatures(77);
    detector->setThreshold(.125f);
    detector->setScales(3);
    detector->setSigma(2.5f);
    detector->setNormalizationSigma(7);
    detector->setWorkingSize(1500);
    EXPECT_EQ("Feature2D.HessianDetector", detector->getDefaultName());
    const auto expectSame = [&](const Ptr<HessianDetector>& copy) {
        ASSERT_TRUE(copy);
        EXPECT_EQ(77, copy->getMaxFeatures());
        EXPECT_EQ(.125f, copy->getThreshold());
        EXPECT_EQ(3, copy->getScales());
        EXPECT_EQ(2.5f, copy->getSigma());
        EXPECT_EQ(7.f, copy->getNormalizationSigma());
        EXPECT_EQ(1500, copy->getWorkingSize());
    };
    forEachFileOf<Feature2D>(*detector, [&](const String& file) {
        const Ptr<HessianDetector> copy = HessianDetector::create();
        copy->Feature2D::read(file);
        expectSame(copy);
        expectSame(Algorithm::load<HessianDetector>(file));
    });
    const Ptr<HessianDetector> other = HessianDetector::create();
    expectError(Error::StsParseError, "HessianDetector", [&] { other->read(FileNode()); });
    FileStorage wrong("{\"format\": 1, \"scales\": 99}", FileStorage::READ | FileStorage::MEMORY);
    expectError(Error::StsOutOfRange, "scales", [&] { other->read(wrong.root()); });
    EXPECT_EQ(HessianDetector::create()->getScales(), other->getScales());
}

}}  // namespace opencv_test
