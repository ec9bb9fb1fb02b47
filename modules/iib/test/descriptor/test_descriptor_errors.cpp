// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#include "../support/test_errors.hpp"
#include "../support/describe.hpp"

namespace opencv_test { namespace {

const Size SIZE(60, 50);

//! compute() throws, and leaves its outputs as they were.
void expectComputeError(IIB& iib, int code, const String& culprit, const Mat& image,
        const std::vector<Mat>& extra,
        const std::vector<KeyPoint>& keypoints = std::vector<KeyPoint>(3, KeyPoint(1, 1, 20)))
{
    const Mat before = Mat_<float>({1, 2}, {3, 4});
    for (int border = 0; border < 2; border++)
    {
        iib.setBorder(border);
        std::vector<KeyPoint> copy = keypoints;
        Mat descriptors = before.clone();
        expectError(code, culprit, [&] { iib.compute(image, extra, copy, descriptors); });
        EXPECT_EQ(keypoints.size(), copy.size());
        EXPECT_EQ(0, cvtest::norm(before, descriptors, NORM_INF));
    }
}

TEST(IIB_Errors, images)
{
    const Ptr<IIB> iib = IIB::create();
    const std::vector<Mat> none;
    for (int depth : {CV_8S, CV_16S, CV_32S, CV_64F})
        expectComputeError(*iib, Error::StsUnsupportedFormat, "the image has type " + typeToString(depth),
                Mat::zeros(SIZE, depth), none);
    for (int channels : {2, 5})
        expectComputeError(*iib, Error::StsBadArg, format("%d channels", channels),
                Mat::zeros(SIZE, CV_8UC(channels)), none);
    const int sizes[] = {10, 10, 10};
    expectComputeError(*iib, Error::StsBadArg, "3 dimensions", Mat(3, sizes, CV_8U, Scalar(0)), none);
}

TEST(IIB_Errors, pixels_that_are_not_finite)
{
    const Ptr<IIB> iib = IIB::create(), withMap = IIB::create(2.f, 4, 15, 0, false, false, 2);
    for (float bad : {NOT_A_NUMBER, ENDLESS, -ENDLESS})
        for (int channels : {1, 3, 4})
        {
            Mat image(SIZE, CV_32FC(channels), Scalar::all(1));
            image.ptr<float>(SIZE.height - 1)[SIZE.width * channels - 1] = bad;
            expectComputeError(*iib, Error::StsBadArg, "the image is NaN or infinite at (59, 49)", image,
                    std::vector<Mat>());
            if (channels > 1)
                continue;
            const std::vector<Mat> maps = {Mat::zeros(SIZE, CV_32F), image};
            expectComputeError(*withMap, Error::StsBadArg, "extra channel 1 is NaN or infinite at (59, 49)",
                    Mat::zeros(SIZE, CV_8U), maps);
            const Mat finite = image(Rect(0, 0, SIZE.width - 1, SIZE.height));
            EXPECT_NO_THROW(describe(*iib, finite, std::vector<KeyPoint>(1, KeyPoint(9, 9, 9))));
        }
}

TEST(IIB_Errors, extra_channels)
{
    const Ptr<IIB> iib = IIB::create(2.f, 4, 15, 0, false, false, 2);
    const Mat image = Mat::zeros(SIZE, CV_8U);
    for (int count : {0, 1, 3})
        expectComputeError(*iib, Error::StsBadArg,
                format("%d extra channels were given to an extractor of 2", count), image,
                std::vector<Mat>(count, image));
    expectComputeError(*IIB::create(), Error::StsBadArg, "1 extra channels were given to an extractor of 0",
            image, std::vector<Mat>(1, image));
    const Mat smaller = Mat::zeros(SIZE.height, SIZE.width - 1, CV_8U);
    expectComputeError(*iib, Error::StsUnmatchedSizes, "extra channel 1 is 59 x 50", image, {image, smaller});
    expectComputeError(*iib, Error::StsUnmatchedSizes, "extra channel 0 is 0 x 0", image, {Mat(), image});
    expectComputeError(*iib, Error::StsBadArg, "extra channel 1 has 3 channels", image,
            {image, Mat::zeros(SIZE, CV_8UC3)});
    for (int depth : {CV_8S, CV_16S, CV_32S, CV_64F})
        expectComputeError(*iib, Error::StsUnsupportedFormat,
                "extra channel 0 has type " + typeToString(depth), image, {Mat::zeros(SIZE, depth), image});
    std::vector<KeyPoint> keypoints;
    Mat descriptors;
    expectError(Error::StsBadArg, "0 extra channels were given",
            [&] { iib->compute(image, keypoints, descriptors); });
    expectError(Error::StsBadArg, "0 extra channels were given",
            [&] { iib->detectAndCompute(texture(SIZE, CV_8U, 1), noArray(), keypoints, descriptors); });
}

TEST(IIB_Errors, keypoints)
{
    const Mat image = Mat::zeros(SIZE, CV_8U);
    for (float bad : {NOT_A_NUMBER, ENDLESS, -ENDLESS})
        for (const KeyPoint& kp :
                {KeyPoint(bad, 1, 9), KeyPoint(1, bad, 9), KeyPoint(1, 1, bad), KeyPoint(1, 1, 9, bad)})
        {
            const Ptr<IIB> iib = IIB::create();
            iib->setUseOrientation(true);
            expectComputeError(*iib, Error::StsBadArg, "keypoint 1 is at", image, std::vector<Mat>(),
                    {KeyPoint(1, 1, 9), kp});
        }
    for (float size : {0.f, -1.f})
        expectComputeError(*IIB::create(), Error::StsBadArg, format("with size %g", size), image,
                std::vector<Mat>(), {KeyPoint(1, 1, 9), KeyPoint(1, 1, 9), KeyPoint(1, 1, size)});
}

// Detectors may leave any angle; it does not change bits.
TEST(IIB_Errors, angles_that_nobody_reads_may_be_anything)
{
    const Mat image = texture(SIZE, CV_8U, 1);
    const Ptr<IIB> iib = IIB::create();
    for (int orientation : {IIB::ORIENTATION_NONE, IIB::ORIENTATION_GRADIENT})
        for (float angle : {NOT_A_NUMBER, ENDLESS})
        {
            iib->setOrientation(orientation);
            std::vector<KeyPoint> keypoints = {KeyPoint(30, 20, 9, angle)};
            Mat bits;
            iib->compute(image, keypoints, bits);
            EXPECT_EQ(0, differingBits(describe(*iib, image, {KeyPoint(30, 20, 9, 5)}), bits));
        }
}

TEST(IIB_Errors, detectors_without_a_scale_factor)
{
    for (const char* name : {"", "HARRIS", "ORB2", "Feature2D."})
        expectError(Error::StsBadArg, "akaze, orb, brisk", [=] { IIB::scaleFactorFor(name); });
    expectError(Error::StsNullPtr, "name is null", [] { IIB::scaleFactorFor((const char*)0); });
    expectError(Error::StsNullPtr, "the detector is null", [] { IIB::scaleFactorFor(Ptr<Feature2D>()); });
    expectError(
            Error::StsBadArg, "Feature2D.IIB", [] { IIB::scaleFactorFor(Ptr<Feature2D>(IIB::create())); });
}

// detect() would recurse without end.
TEST(IIB_Errors, no_extractor_detects_by_itself)
{
    const Ptr<IIB> a = IIB::create(), b = IIB::create();
    expectError(Error::StsBadArg, "its own detector", [=] { a->setDetector(a); });
    b->setDetector(a);
    expectError(Error::StsBadArg, "its own detector", [=] { a->setDetector(b); });
    expectError(Error::StsBadArg, "its own detector", [=] { a->setDetector(NormalizedDetector::create(b)); });
    EXPECT_EQ("Feature2D.ORB", a->getDetector()->getDefaultName());
}

}}  // namespace opencv_test
