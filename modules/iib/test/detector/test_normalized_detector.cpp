// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#include "../support/temporary_file.hpp"
#include "../support/test_errors.hpp"
#include "../support/test_images.hpp"
#include "../normalization/normalization_oracle.hpp"

namespace opencv_test { namespace {

TEST(IIB_NormalizedDetector, finds_the_keypoints_of_the_normalized_image)
{
    const Mat image = relit(scene(Size(320, 240), 1), 2);
    Mat left = Mat::zeros(image.size(), CV_8U);
    left.colRange(0, 150) = 255;
    for (const Ptr<Feature2D>& detector : {Ptr<Feature2D>(ORB::create()), Ptr<Feature2D>(AKAZE::create())})
        for (const Mat& mask : {Mat(), left})
        {
            const std::vector<KeyPoint> expected = found(*detector, oracle::normalizeLocally(image, 4), mask);
            ASSERT_GT(expected.size(), mask.empty() ? 50u : 10u);
            expectSameKeyPoints(expected, found(*NormalizedDetector::create(detector), image, mask));
        }
}

TEST(IIB_NormalizedDetector, describes_the_plain_image_with_the_detector_inside)
{
    const Mat image = relit(scene(Size(320, 240), 1), 2);
    const Ptr<Feature2D> orb = ORB::create();
    const Ptr<NormalizedDetector> detector = NormalizedDetector::create(orb, 3.f);
    EXPECT_EQ(orb->descriptorSize(), detector->descriptorSize());
    EXPECT_EQ(orb->descriptorType(), detector->descriptorType());
    EXPECT_EQ(orb->defaultNorm(), detector->defaultNorm());
    EXPECT_FALSE(detector->empty());

    Mat expectedDescriptors, descriptors;
    const std::vector<KeyPoint> detected = found(*detector, image);
    std::vector<KeyPoint> expected = detected, keypoints;
    orb->compute(image, expected, expectedDescriptors);
    detector->detectAndCompute(image, noArray(), keypoints, descriptors);
    expectSameKeyPoints(expected, keypoints);
    EXPECT_EQ(0, differingBits(expectedDescriptors, descriptors));

    keypoints = detected;
    detector->compute(image, keypoints, descriptors);
    EXPECT_EQ(0, differingBits(expectedDescriptors, descriptors));
    keypoints = detected;
    detector->detectAndCompute(image, noArray(), keypoints, descriptors, true);
    EXPECT_EQ(0, differingBits(expectedDescriptors, descriptors));
    detector->detectAndCompute(image, noArray(), keypoints, noArray());
    expectSameKeyPoints(detected, keypoints);
}

TEST(IIB_NormalizedDetector, errors)
{
    expectError(Error::StsNullPtr, "detector is null", [] { NormalizedDetector::create(Ptr<Feature2D>()); });
    for (float sigma : {0.f, -4.f, 0.99f, 257.f, NOT_A_NUMBER, ENDLESS})
    {
        expectError(Error::StsOutOfRange, "sigma", [&] { NormalizedDetector::create(ORB::create(), sigma); });
        const Ptr<NormalizedDetector> detector = NormalizedDetector::create(ORB::create());
        expectError(Error::StsOutOfRange, "sigma", [&] { detector->setSigma(sigma); });
        EXPECT_EQ(4.f, detector->getSigma());
    }

    const Ptr<NormalizedDetector> fast = NormalizedDetector::create(FastFeatureDetector::create());
    std::vector<KeyPoint> keypoints;
    Mat descriptors;
    const Mat image = texture(Size(100, 80), CV_8U, 1);
    fast->detect(image, keypoints);
    EXPECT_FALSE(keypoints.empty());
    expectError(Error::StsNotImplemented, "createFor", [&] { fast->compute(image, keypoints, descriptors); });
    expectError(Error::StsNotImplemented, "createFor",
            [&] { fast->detectAndCompute(image, noArray(), keypoints, descriptors); });
    keypoints.resize(3);
    fast->detect(Mat(), keypoints);
    EXPECT_TRUE(keypoints.empty());
}

TEST(IIB_NormalizedDetector, parameters_and_files)
{
    const Ptr<Feature2D> inside = ORB::create(77);
    const Ptr<NormalizedDetector> detector = NormalizedDetector::create(inside, 5.f);
    EXPECT_EQ(inside, detector->getDetector());
    detector->setSigma(6.5f);
    EXPECT_EQ(6.5f, detector->getSigma());
    EXPECT_EQ("Feature2D.NormalizedDetector", detector->getDefaultName());

    const Ptr<NormalizedDetector> copy = NormalizedDetector::create(ORB::create());
    forEachFileOf<Feature2D>(*detector, [&](const String& file) {
        const FileStorage fs(file, FileStorage::READ);
        for (const FileNode& node : {fs.root(), fs.getFirstTopLevelNode()})
        {
            copy->setSigma(1);
            copy->read(node);
            EXPECT_EQ(6.5f, copy->getSigma());
            const Ptr<ORB> orb = copy->getDetector().dynamicCast<ORB>();
            ASSERT_TRUE(orb);
            EXPECT_EQ(77, orb->getMaxFeatures());
        }
    });
    expectError(Error::StsParseError, "NormalizedDetector", [&] { copy->read(FileNode()); });
    const FileStorage other(
            "{\"format\": 1, \"class\": \"Feature2D.ORB\"}", FileStorage::READ | FileStorage::MEMORY);
    EXPECT_THROW(copy->read(other.root()), cv::Exception);
}

}}  // namespace opencv_test
