// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#include "../support/test_errors.hpp"
#include "../support/test_images.hpp"

namespace opencv_test {
namespace {

//! A detector that the library does not know.
class Unknown : public Feature2D
{
public:
    String getDefaultName() const CV_OVERRIDE { return "Feature2D.Unknown"; }
};

TEST(IIB_CreateFor, detector_factor_and_preset)
{
    const std::pair<Ptr<Feature2D>, float> known[] = {{ORB::create(), 2.f}, {AKAZE::create(), 12.f},
            {SIFT::create(), 20.f}, {KAZE::create(), 20.f}, {BRISK::create(), 4.f},
            {FastFeatureDetector::create(), 64.f / 7}, {AgastFeatureDetector::create(), 64.f / 7},
            {GFTTDetector::create(), 64.f / 3}, {MSER::create(), 2.f}, {SimpleBlobDetector::create(), 4.f}};
    for (const auto& k : known)
        for (const Ptr<Feature2D>& detector : {k.first, Ptr<Feature2D>(NormalizedDetector::create(k.first)),
                     Ptr<Feature2D>(NormalizedDetector::create(NormalizedDetector::create(k.first)))})
        {
            SCOPED_TRACE(k.first->getDefaultName());
            EXPECT_FLOAT_EQ(k.second, IIB::scaleFactorFor(detector));
            const Ptr<IIB> iib = IIB::createFor(detector);
            EXPECT_EQ(detector, iib->getDetector());
            EXPECT_FLOAT_EQ(k.second, iib->getScaleFactor());
            EXPECT_EQ(170, iib->descriptorSize());
            for (int preset = IIB::PRESET_S128; preset <= IIB::PRESET_UNIVERSAL; preset++)
            {
                const Ptr<IIB> expected = IIB::createPreset(preset, k.second),
                               actual = IIB::createFor(detector, preset);
                EXPECT_EQ(detector, actual->getDetector());
                EXPECT_EQ(expected->getScaleFactor(), actual->getScaleFactor());
                EXPECT_EQ(expected->levelSizes(), actual->levelSizes());
            }
        }
}

TEST(IIB_CreateFor, describes_what_its_detector_finds_on_the_plain_image)
{
    const Mat image = relit(scene(Size(320, 240), 3), 4);
    const Ptr<Feature2D> detector = NormalizedDetector::create(ORB::create(200));
    const Ptr<IIB> iib = IIB::createFor(detector);
    std::vector<KeyPoint> expected, keypoints;
    Mat descriptors;
    detector->detect(image, expected);
    iib->detectAndCompute(image, noArray(), keypoints, descriptors);
    ASSERT_GT(expected.size(), 50u);
    expectSameKeyPoints(expected, keypoints);
    EXPECT_EQ(0, differingBits(describe(*IIB::create(2.f), image, expected), descriptors));
}

//! IIB as a detector: it finds another one's keypoints.
Ptr<Feature2D> iibOf(const Ptr<Feature2D>& detector, int preset = -1)
{
    return IIB::createFor(detector, preset);
}

//! An AffineFeature that looks at the image itself alone, which is quick.
Ptr<Feature2D> oneView(const Ptr<Feature2D>& backend)
{
    const Ptr<AffineFeature> affine = AffineFeature::create(backend, 1);
    affine->setViewParams({1.f}, {0.f});
    return affine;
}

/* Size and type of the descriptors do not tell ORB, AKAZE and IIB apart, nor BRISK and IIB, nor KAZE and SURF. Without
 MSER, which keeps what it works on in members: AffineFeature calls one object from several threads. */
TEST(IIB_CreateFor, affine_feature_takes_the_factor_of_its_backend)
{
    const std::pair<Ptr<Feature2D>, float> backends[] = {
        {ORB::create(), 2.f},
        {ORB::create(5), 2.f},
        {ORB::create(500, 1.5f, 3, 20, 0, 3, ORB::FAST_SCORE), 2.f},
        {SIFT::create(), 20.f},
        {SIFT::create(10), 20.f},
        {iibOf(SIFT::create(), IIB::PRESET_S256), 20.f},
        {iibOf(SIFT::create(), IIB::PRESET_S512), 20.f},
        {NormalizedDetector::create(ORB::create()), 2.f},
        {iibOf(FastFeatureDetector::create()), 64.f / 7},
        {iibOf(GFTTDetector::create()), 64.f / 3},
        {iibOf(SimpleBlobDetector::create()), 4.f},
#if CV_VERSION_MAJOR < 5
        {AKAZE::create(), 12.f},
        {AKAZE::create(AKAZE::DESCRIPTOR_MLDB, 256), 12.f},
        {AKAZE::create(AKAZE::DESCRIPTOR_KAZE), 12.f},
        {KAZE::create(), 20.f},
        {KAZE::create(true, true), 20.f},
        {BRISK::create(), 4.f},
        {BRISK::create(60, 1), 4.f},
        {iibOf(AgastFeatureDetector::create()), 64.f / 7}
#endif
    };
    for (const auto& b : backends)
    {
        SCOPED_TRACE(format("%s, %d bytes", b.first->getDefaultName().c_str(), b.first->descriptorSize()));
        const Ptr<Feature2D> affine = oneView(b.first);
        EXPECT_FLOAT_EQ(b.second, IIB::scaleFactorFor(affine));
    }
    const Ptr<Feature2D> all = NormalizedDetector::create(AffineFeature::create(SIFT::create()));
    EXPECT_EQ(20.f, IIB::createFor(all)->getScaleFactor());
}

//! Finds what no other detector does.
class Centre : public Feature2D
{
public:
    using Feature2D::detect;
    void detectAndCompute(
            InputArray image, InputArray, std::vector<KeyPoint>& keypoints, OutputArray, bool) CV_OVERRIDE
    {
        keypoints.assign(1, KeyPoint(image.size().width / 2.f, image.size().height / 2.f, 17));
    }
    int descriptorSize() const CV_OVERRIDE { return 32; }
    int descriptorType() const CV_OVERRIDE { return CV_8U; }
};

TEST(IIB_CreateFor, affine_feature_of_an_unknown_backend)
{
    const Ptr<ORB> other = ORB::create();
    other->setPatchSize(25);
    for (const Ptr<Feature2D>& backend : {Ptr<Feature2D>(makePtr<Centre>()), Ptr<Feature2D>(other)})
        expectError(Error::StsBadArg, "give create() the scale factor",
                [&] { IIB::scaleFactorFor(oneView(backend)); });
}

TEST(IIB_CreateFor, errors)
{
    expectError(Error::StsNullPtr, "detector is null", [] { IIB::createFor(Ptr<Feature2D>()); });
    for (const Ptr<Feature2D>& unknown : {Ptr<Feature2D>(makePtr<Unknown>()),
                 Ptr<Feature2D>(NormalizedDetector::create(makePtr<Unknown>()))})
        expectError(Error::StsBadArg, "Unknown", [&] { IIB::createFor(unknown); });
    expectError(Error::StsBadArg, "give create() the ROS side divided by KeyPoint::size",
            [] { IIB::createFor(makePtr<Unknown>()); });
    for (int preset : {-2, 1000})
        expectError(Error::StsBadArg, format("preset is %d", preset),
                [=] { IIB::createFor(ORB::create(), preset); });
}

}  // namespace
}  // namespace opencv_test
