// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#include "perf_precomp.hpp"

namespace opencv_test { namespace {

//! Finds no keypoints, so that NormalizedDetector only normalizes.
class FindsNothing : public Feature2D
{
public:
    using Feature2D::detect;
    void detect(InputArray, std::vector<KeyPoint>& keypoints, InputArray) CV_OVERRIDE { keypoints.clear(); }
};

typedef perf::TestBaseWithParam<tuple<std::string, std::string, int>>
        IIB_Detect;  // picture, detector, points

PERF_TEST_P(IIB_Detect, vga,
        testing::Combine(testing::Values("scene", "street_noon"),
                testing::Values("ORB detects", "HessianDetector", "normalization"),
                testing::Values(1000, 2000)))
{
    const std::string name = get<1>(GetParam());
    const int points = get<2>(GetParam());
    const Mat image = picture(get<0>(GetParam()));
    Ptr<Feature2D> detector = ORB::create(points);
    if (name == "HessianDetector")
        detector = HessianDetector::create(points);
    else if (name == "normalization")
        detector = NormalizedDetector::create(makePtr<FindsNothing>());
    std::vector<KeyPoint> keypoints;
    const Threads one(1);
    TEST_CYCLE() detector->detect(image, keypoints);
    RecordProperty("points", (int)keypoints.size());
    SANITY_CHECK_NOTHING();
}

}}  // namespace opencv_test
