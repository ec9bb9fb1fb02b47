// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#include "../support/temporary_file.hpp"
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
    std::vector<KeyPoint> expected, keypoints;
    Mat descriptors;
    HessianDetector::create(200)->detect(image, expected);
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

}  // namespace
}  // namespace opencv_test
