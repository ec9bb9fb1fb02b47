// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#include "../support/describe.hpp"
#include "../support/test_errors.hpp"
#include "../support/temporary_file.hpp"

namespace opencv_test { namespace {

struct DetectorCase
{
    const char* name;
    Ptr<Feature2D> (*create)();
    float scaleFactor;
    int minCorrect;  //!< about two thirds of the measured number
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
    EXPECT_FLOAT_EQ(p.scaleFactor, IIB::createFor(NormalizedDetector::create(detector))->getScaleFactor());
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
    const Ptr<Feature2D> orb = ORB::create();  // the default
    for (const Ptr<Feature2D>& detector :
            {orb, Ptr<Feature2D>(BRISK::create()), Ptr<Feature2D>(NormalizedDetector::create(orb))})
    {
        if (detector != orb)
            iib->setDetector(detector);
        std::vector<KeyPoint> expected = found(*detector, image), keypoints(5);
        ASSERT_GT(expected.size(), 10u);
        expectSameKeyPoints(expected, found(*iib, image));
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

//! A texture that reaches from 0 to 255, in another type.
Mat converted(const Mat& grey, int type)
{
    Mat image;
    grey.convertTo(image, CV_MAT_DEPTH(type), CV_MAT_DEPTH(type) == CV_16U ? 257 : 1 / 255.);
    merge(std::vector<Mat>(CV_MAT_CN(type), image), image);
    return image;
}

// ORB, BRISK and SIFT only support 8 bits; ORB misreads CV_32FC3.
TEST(IIB_Detector, images_of_every_type)
{
    Mat grey = scene(Size(240, 200), 3);
    normalize(grey, grey, 0, 255, NORM_MINMAX);
    for (const Ptr<Feature2D>& detector : {Ptr<Feature2D>(ORB::create()), Ptr<Feature2D>(BRISK::create()),
                 Ptr<Feature2D>(SIFT::create()), Ptr<Feature2D>(AKAZE::create())})
        for (int type : {CV_16UC1, CV_16UC3, CV_32FC1, CV_32FC3, CV_32FC4})
        {
            SCOPED_TRACE(detector->getDefaultName() + " " + typeToString(type));
            const Mat image = converted(grey, type);
            std::vector<KeyPoint> expected = found(*detector, grey), detected;
            ASSERT_GT(expected.size(), 10u);
            Mat descriptors;
            const Ptr<IIB> iib = IIB::createFor(detector);
            iib->detectAndCompute(image, noArray(), detected, descriptors);
            expectSameKeyPoints(expected, detected);
            EXPECT_EQ(0, differingBits(describe(*iib, image, expected), descriptors));

            const Ptr<NormalizedDetector> inside = NormalizedDetector::create(detector);
            Mat own, expectedOwn;
            detector->compute(grey, expected, expectedOwn);
            inside->compute(image, detected, own);
            expectSameKeyPoints(expected, detected);
            EXPECT_EQ(0, cvtest::norm(expectedOwn, own, NORM_INF));
        }
}

// An extractor within a NormalizedDetector gets the unchanged image.
TEST(IIB_Detector, extractors_inside_get_all_of_an_image)
{
    const Mat image = texture(Size(200, 180), CV_16U, 3);
    std::vector<KeyPoint> keypoints = scatter(image.size(), 20, 8.f, 20.f, 4);
    const Ptr<IIB> iib = IIB::create();
    Mat descriptors;
    NormalizedDetector::create(iib)->compute(image, keypoints, descriptors);
    EXPECT_EQ(0, differingBits(describe(*iib, image, keypoints), descriptors));
}

//! An extractor, and a detector of the normalized image.
std::vector<Ptr<Feature2D>> bothWith(const Ptr<Feature2D>& detector)
{
    return {IIB::createFor(detector), NormalizedDetector::create(detector)};
}

// ORB of OpenCV 4.6 scales the mask, and allows values above 254 only.
TEST(IIB_Detector, any_number_in_a_mask_but_0_allows)
{
    const Mat image = scene(Size(320, 240), 1);
    Mat ones = Mat::zeros(image.size(), CV_8U);
    ones.colRange(40, 280).setTo(1);
    for (const Ptr<Feature2D>& detector : bothWith(ORB::create()))
    {
        const std::vector<KeyPoint> expected = found(*detector, image, ones * 255);
        ASSERT_GT(expected.size(), 50u);
        expectSameKeyPoints(expected, found(*detector, image, ones));
    }
}

TEST(IIB_Detector, masks_and_images_that_are_refused)
{
    const Mat image = scene(Size(100, 80), 1);
    Mat broken = Mat::ones(image.size(), CV_32F);
    broken.at<float>(7, 9) = NOT_A_NUMBER;
    for (const Ptr<Feature2D>& inside : {Ptr<Feature2D>(ORB::create()), Ptr<Feature2D>(AKAZE::create())})
        for (const Ptr<Feature2D>& detector : bothWith(inside))
        {
            std::vector<KeyPoint> keypoints(1, KeyPoint(50, 40, 9));
            Mat descriptors;
            expectError(Error::StsUnmatchedSizes, "the mask is 80 x 80; the image is 100 x 80",
                    [&] { detector->detect(image, keypoints, Mat::ones(80, 80, CV_8U)); });
            for (int type : {CV_8UC3, CV_8S, CV_32F})
                expectError(Error::StsUnsupportedFormat, "the mask has type " + typeToString(type),
                        [&] { detector->detect(image, keypoints, Mat::ones(image.size(), type)); });
            expectError(
                    Error::StsBadArg, "(9, 7)", [&] { detector->compute(broken, keypoints, descriptors); });
            expectError(Error::StsBadArg, "(9, 7)", [&] { detector->detect(broken, keypoints); });
            expectError(Error::StsBadArg, "2 channels",
                    [&] { detector->detect(Mat(30, 30, CV_8UC2), keypoints); });
            expectError(Error::StsUnsupportedFormat, "CV_64F",
                    [&] { detector->detect(Mat::zeros(30, 30, CV_64F), keypoints); });
        }
}

TEST(IIB_ScaleFactor, surf_and_names_of_classes)
{
    EXPECT_EQ(4, IIB::scaleFactorFor("SURF"));
    EXPECT_EQ(4, IIB::scaleFactorFor("Feature2D.SURF"));
    EXPECT_FLOAT_EQ(64.f / 7, IIB::scaleFactorFor("FastFeatureDetector"));
    EXPECT_FLOAT_EQ(64.f / 3, IIB::scaleFactorFor("Feature2D.GFTTDetector"));
}

//! A detector that the library does not know.
class Unknown : public Feature2D
{
public:
    String getDefaultName() const CV_OVERRIDE { return "Feature2D.Unknown"; }
};

TEST(IIB_CreateFor, detector_factor_and_preset)
{
    const Ptr<Feature2D> orb = ORB::create();  // for others see IIB_Detectors
    for (const Ptr<Feature2D>& detector : {orb, Ptr<Feature2D>(NormalizedDetector::create(orb)),
                 Ptr<Feature2D>(NormalizedDetector::create(NormalizedDetector::create(orb)))})
    {
        const Ptr<IIB> iib = IIB::createFor(detector);
        EXPECT_EQ(detector, iib->getDetector());
        EXPECT_EQ(2.f, iib->getScaleFactor());
        EXPECT_EQ(170, iib->descriptorSize());
        for (int preset = IIB::PRESET_S128; preset <= IIB::PRESET_SMALL; preset++)
        {
            const Ptr<IIB> expected = IIB::createPreset(preset, 2.f),
                           actual = IIB::createFor(detector, preset);
            EXPECT_EQ(detector, actual->getDetector());
            EXPECT_EQ(expected->getScaleFactor(), actual->getScaleFactor());
            EXPECT_EQ(expected->levelSizes(), actual->levelSizes());
        }
    }
}

TEST(IIB_CreateFor, recommended_is_hessian_and_universal)
{
    const Mat image = relit(scene(Size(320, 240), 3), 4);
    const Ptr<IIB> iib = IIB::createRecommended(200);
    const std::vector<KeyPoint> expected = found(*HessianDetector::create(200), image);
    std::vector<KeyPoint> keypoints;
    Mat descriptors;
    iib->detectAndCompute(image, noArray(), keypoints, descriptors);
    ASSERT_GT(expected.size(), 100u);
    expectSameKeyPoints(expected, keypoints);
    const Ptr<IIB> universal =
            IIB::createPreset(IIB::PRESET_UNIVERSAL, IIB::scaleFactorFor("HessianDetector"));
    EXPECT_EQ(0, differingBits(describe(*universal, image, expected), descriptors));

    const TemporaryFile file(".yml");
    iib->save(file.name);
    const Ptr<IIB> copy = Algorithm::load<IIB>(file.name);
    ASSERT_TRUE(copy);
    Mat others;
    copy->detectAndCompute(image, noArray(), keypoints, others);
    expectSameKeyPoints(expected, keypoints);
    EXPECT_EQ(0, differingBits(descriptors, others));
    expectError(Error::StsOutOfRange, "maxFeatures", [] { IIB::createRecommended(-1); });
}

TEST(IIB_CreateFor, errors)
{
    expectError(Error::StsNullPtr, "detector is null", [] { IIB::createFor(Ptr<Feature2D>()); });
    expectError(Error::StsBadArg, "Unknown",
            [&] { IIB::createFor(NormalizedDetector::create(makePtr<Unknown>())); });
    for (const Ptr<Feature2D>& unknown :
            {Ptr<Feature2D>(makePtr<Unknown>()), Ptr<Feature2D>(AffineFeature::create(SIFT::create()))})
        expectError(Error::StsBadArg, "give create() the ROS side divided by KeyPoint::size",
                [&] { IIB::createFor(unknown); });
    for (int preset : {-2, 10})
        expectError(Error::StsBadArg, format("preset is %d", preset),
                [=] { IIB::createFor(ORB::create(), preset); });
}

}}  // namespace opencv_test
