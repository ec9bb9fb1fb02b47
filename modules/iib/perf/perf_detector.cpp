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

//! What a program does with an image: finds points by itself and describes them, if it has what describes.
struct Chain
{
    Ptr<Feature2D> detector, descriptor;

    explicit Chain(const std::string& name, int points)
    {
        if (name == "normalization")
            detector = NormalizedDetector::create(makePtr<FindsNothing>());
        else if (name == "HessianDetector" || name == "recommended chain")
            detector = HessianDetector::create(points);
        else if (name == "SIFT")
            detector = SIFT::create(points);
#if CV_VERSION_MAJOR < 5
        else if (name == "AKAZE")
            detector = AKAZE::create(AKAZE::DESCRIPTOR_MLDB_UPRIGHT);
        else if (name == "BRISK")
            detector = BRISK::create();
        else if (name == "KAZE")
            detector = KAZE::create(false, true);
#endif
        else
            detector = ORB::create(points);
        if (name == "recommended chain")
            descriptor = IIB::createFor(detector, IIB::PRESET_UNIVERSAL);
        else if (name == "IIB at ORB's points")
            descriptor = IIB::createFor(detector);
        else if (name != "normalization" && name != "HessianDetector" && name != "ORB detects")
            descriptor = detector;
    }

    void run(const Mat& image)
    {
        if (detector == descriptor)
            return detector->detectAndCompute(image, noArray(), keypoints, descriptors);
        detector->detect(image, keypoints);
        if (descriptor)
            descriptor->compute(image, keypoints, descriptors);
    }

    std::vector<KeyPoint> keypoints;
    Mat descriptors;
};

class IIB_Chain
    : public perf::TestBaseWithParam<tuple<std::string, std::string, int>>  // picture, method, points
{
protected:
    void time()
    {
        const Mat image = picture(get<0>(GetParam()));
        Chain chain(get<1>(GetParam()), get<2>(GetParam()));
        chain.run(image);
        RecordProperty("points", (int)chain.keypoints.size());
        const Threads one(1);
        TEST_CYCLE() chain.run(image);
        SANITY_CHECK_NOTHING();
    }
};

PERF_TEST_P(IIB_Chain, vga,
        testing::Combine(testing::Values("scene", "street_noon"),
                testing::Values("ORB detects", "HessianDetector", "ORB", "recommended chain"),
                testing::Values(1000, 2000)))
{
    time();
}

const std::string OTHERS[] = {"normalization", "IIB at ORB's points", "SIFT",
#if CV_VERSION_MAJOR < 5
        "BRISK", "AKAZE", "KAZE"
#endif
};

PERF_TEST_P(IIB_Chain, others,
        testing::Combine(testing::Values("street_noon"), testing::ValuesIn(OTHERS), testing::Values(1000)))
{
    time();
}

}  // namespace
}  // namespace opencv_test
