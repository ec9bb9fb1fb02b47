// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#include "../support/detected_matches.hpp"

namespace opencv_test {
namespace {

struct DetectorCase
{
    const char* name;
    Ptr<Feature2D> (*create)();
    float scaleFactor;
    int minCorrect;  //!< about two thirds of what was measured
};

template <typename T> Ptr<Feature2D> make() { return T::create(); }

template <> Ptr<Feature2D> make<MSER>()
{
    const Ptr<MSER> detector = MSER::create();
#if CV_VERSION_MAJOR >= 5
    // 5.0 takes it for the least variation of a region too: the default leaves 87 regions here, the least stable ones.
    detector->setMinDiversity(0);
#endif
    return detector;
}

const DetectorCase DETECTORS[] = {{"FAST", make<FastFeatureDetector>, 64.f / 7, 220},
        {"AGAST", make<AgastFeatureDetector>, 64.f / 7, 215}, {"ORB", make<ORB>, 2, 185},
        {"BRISK", make<BRISK>, 4, 200}, {"AKAZE", make<AKAZE>, 12, 235}, {"KAZE", make<KAZE>, 20, 210},
        {"SIFT", make<SIFT>, 20, 125}, {"GFTT", make<GFTTDetector>, 64.f / 3, 210},
        {"MSER", make<MSER>, 2, 280}, {"SimpleBlob", make<SimpleBlobDetector>, 4, 28}};

class IIB_Detectors : public testing::TestWithParam<DetectorCase>
{
};

TEST_P(IIB_Detectors, detect_compute_and_match)
{
    const DetectorCase& p = GetParam();
    const Ptr<Feature2D> detector = p.create();
    EXPECT_FLOAT_EQ(p.scaleFactor, IIB::scaleFactorFor(detector));
    EXPECT_FLOAT_EQ(p.scaleFactor, IIB::scaleFactorFor(p.name));
    EXPECT_FLOAT_EQ(p.scaleFactor, IIB::scaleFactorFor(cv::toLowerCase(p.name)));
    EXPECT_FLOAT_EQ(p.scaleFactor, IIB::scaleFactorFor(detector->getDefaultName()));

    Mat images[2];
    images[0] = scene(Size(480, 360), 3);
    images[1] = relit(images[0], 4);
    const DetectedMatches found = matchDetected(detector, images, 500);
    std::cout << format("[          ] %s: %d and %d keypoints, %d matches, %d correct\n", p.name,
            (int)found.keypoints[0], (int)found.keypoints[1], (int)found.matches, found.correct);
    EXPECT_GE(found.correct, p.minCorrect);
    EXPECT_GE(found.correct, 0.8 * found.matches);
}

void PrintTo(const DetectorCase& p, std::ostream* os) { *os << p.name; }

String detectorName(const testing::TestParamInfo<DetectorCase>& info) { return info.param.name; }

INSTANTIATE_TEST_CASE_P(/**/, IIB_Detectors, testing::ValuesIn(DETECTORS), detectorName);

TEST(IIB_Detector, behind_detect_and_compute)
{
    const Mat image = texture(Size(200, 180), CV_8U, 3);
    const Ptr<IIB> iib = IIB::create();
    for (int i = 0; i < 2; i++)
    {
        Ptr<Feature2D> detector = ORB::create();  // the default
        if (i == 1)
            iib->setDetector(detector = BRISK::create());
        std::vector<KeyPoint> expected, detected, keypoints(5);
        detector->detect(image, expected);
        ASSERT_GT(expected.size(), 10u);
        iib->detect(image, detected);
        expectSameKeyPoints(expected, detected);
        Mat descriptors, again;
        iib->detectAndCompute(image, noArray(), keypoints, descriptors);
        expectSameKeyPoints(expected, keypoints);
        EXPECT_EQ(0, differingBits(describe(*iib, image, expected), descriptors));

        keypoints.resize(3);
        keypoints[0].pt += Point2f(5, 5);
        iib->detectAndCompute(image, noArray(), keypoints, again, true);
        ASSERT_EQ(3, again.rows);
        EXPECT_EQ(0, differingBits(descriptors.rowRange(1, 3), again.rowRange(1, 3)));
        EXPECT_NE(0, differingBits(descriptors.row(0), again.row(0)));

        Mat mask = Mat::zeros(image.size(), CV_8U);
        mask.colRange(0, 100) = 255;
        iib->detectAndCompute(image, mask, keypoints, noArray());
        EXPECT_GT(expected.size(), keypoints.size());
        for (const KeyPoint& kp : keypoints)
            EXPECT_LT(kp.pt.x, 100);
    }
}

TEST(IIB_ScaleFactor, surf_and_names_of_classes)
{
    EXPECT_EQ(4, IIB::scaleFactorFor("SURF"));
    EXPECT_EQ(4, IIB::scaleFactorFor("Feature2D.SURF"));
    EXPECT_FLOAT_EQ(64.f / 7, IIB::scaleFactorFor("FastFeatureDetector"));
    EXPECT_FLOAT_EQ(64.f / 3, IIB::scaleFactorFor("Feature2D.GFTTDetector"));
}

}  // namespace
}  // namespace opencv_test
