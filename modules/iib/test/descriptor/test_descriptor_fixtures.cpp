// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#include "../support/describe.hpp"

#include <fstream>

namespace opencv_test { namespace {

/* The core's fixtures read their image by name from OpenCV's own test data, which few machines have. This imread
 hides cv::imread from them: where there is no such file, they get a drawn scene. */
Mat imread(const std::string& name)
{
    return std::ifstream(name.c_str()) ? cv::imread(name) : scene(Size(400, 320), 1);
}

}}  // namespace opencv_test

#if CV_VERSION_MAJOR >= 5
#include "features/test/test_descriptors_invariance.impl.hpp"
#else
#include "features2d/test/test_descriptors_invariance.impl.hpp"
#endif

namespace opencv_test { namespace {

Ptr<IIB> extractorFor(const Ptr<Feature2D>& detector)
{
    return IIB::create(
            IIB::scaleFactorFor(detector), 4, IIB::CHANNELS_DEFAULT, IIB::MAPPING_MEAN, false, true);
}

//! An argument of the fixture: an object up to OpenCV 4.6, a function that makes it in later versions.
struct Given
{
    Ptr<Feature2D> object;
    operator Ptr<Feature2D>() const { return object; }
    Ptr<Feature2D> operator()() const { return object; }
};

String_FeatureDetector_DescriptorExtractor_Float_t pairedWith(
        const Ptr<Feature2D>& detector, float minInliers)
{
    const Given given = {detector}, extractor = {extractorFor(detector)};
    return String_FeatureDetector_DescriptorExtractor_Float_t(
            "cv/features2d/tsukuba.png", given, extractor, minInliers);
}

INSTANTIATE_TEST_CASE_P(IIB, DescriptorRotationInvariance,
        testing::Values(pairedWith(ORB::create(), 0.98f), pairedWith(SIFT::create(400), 0.98f),
                pairedWith(KAZE::create(false, false, 0.005f), 0.98f), pairedWith(BRISK::create(), 0.98f),
                pairedWith(AKAZE::create(), 0.98f)));

INSTANTIATE_TEST_CASE_P(IIB, DescriptorScaleInvariance,
        testing::Values(pairedWith(ORB::create(), 0.98f), pairedWith(SIFT::create(400), 0.98f),
                pairedWith(KAZE::create(false, false, 0.005f), 0.98f), pairedWith(BRISK::create(), 0.8f),
                pairedWith(AKAZE::create(), 0.8f)));

}}  // namespace opencv_test
