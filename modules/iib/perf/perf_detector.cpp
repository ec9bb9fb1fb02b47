// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#include "perf_precomp.hpp"

namespace opencv_test {
namespace {

//! Finds nothing: what is left of a NormalizedDetector is the normalization.
class FindsNothing : public Feature2D
{
public:
    using Feature2D::detect;
    void detect(InputArray, std::vector<KeyPoint>& keypoints, InputArray) CV_OVERRIDE { keypoints.clear(); }
};

enum
{
    PEER_ORB,
    NORMALIZATION,
    NORMALIZED_ORB,
    HESSIAN
};
CV_ENUM(Detector, PEER_ORB, NORMALIZATION, NORMALIZED_ORB, HESSIAN)

Ptr<Feature2D> createDetector(int detector)
{
    switch (detector)
    {
    case NORMALIZATION: return NormalizedDetector::create(makePtr<FindsNothing>());
    case HESSIAN: return HessianDetector::create(1000);
    case NORMALIZED_ORB: return NormalizedDetector::create(ORB::create(1000));
    default: return ORB::create(1000);
    }
}

typedef perf::TestBaseWithParam<Detector> IIB_Detect;

PERF_TEST_P(IIB_Detect, hd, Detector::all())
{
    Mat image(720, 1280, CV_8U);
    randu(image, 0, 256);
    GaussianBlur(image, image, Size(5, 5), 1.);
    const Ptr<Feature2D> detector = createDetector(GetParam());
    std::vector<KeyPoint> keypoints;
    const Threads one(1);
    TEST_CYCLE() detector->detect(image, keypoints);
    SANITY_CHECK_NOTHING();
}

}  // namespace
}  // namespace opencv_test
