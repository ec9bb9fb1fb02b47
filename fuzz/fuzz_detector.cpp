// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

// NormalizedDetector with any image and sigma: a cv::Exception, or what the detector inside sees is the image that the
// naive oracle makes. estimateRotation with any keypoints and matches: a cv::Exception or an angle. Detectors by name
// and of extractors: a factor, keypoints with descriptors, or a cv::Exception.

#include "images.hpp"
#include "detector/normalization_oracle.hpp"

namespace {

using namespace fuzz;
using namespace opencv_test;

void normalize(ByteSource& in)
{
    const bool wild = in.between(0, 7) == 7, odd = in.between(0, 15) == 15;
    const float sigma = wild ? in.number() : 1 + in.between(0, in.rarely(16) ? 1000 : 60) / 4.f;
    const Mat image = takeImage(in, takeSize(in), odd);
    useThreads(in.rarely(128) ? 3 : 1);

    const Ptr<CaptureDetector> capture = makePtr<CaptureDetector>();
    const bool validSigma = sigma >= 1 && sigma <= 256;
    std::vector<KeyPoint> keypoints(2);
    bool thrown = false;
    try
    {
        NormalizedDetector::create(capture, sigma)->detect(image, keypoints);
    }
    catch (const cv::Exception&)
    {
        thrown = true;
    }
    FUZZ_CHECK(thrown == (!validSigma || (!image.empty() && !isImage(image))));
    if (thrown || image.empty())
        return;
    FUZZ_CHECK(keypoints.empty() && capture->seen.size() == image.size() && capture->seen.type() == CV_8U);
    if (image.channels() == 1 && image.depth() != CV_32F)
        FUZZ_CHECK(cv::norm(oracle::normalizeLocally(image, sigma), capture->seen, NORM_INF) == 0);
}

std::vector<KeyPoint> takePoints(ByteSource& in)
{
    std::vector<KeyPoint> keypoints;
    for (int i = in.between(0, 12); i > 0; i--)
    {
        const float x = in.number();
        keypoints.push_back(KeyPoint(Point2f(x, in.number()), 1));
    }
    return keypoints;
}

void rotation(ByteSource& in)
{
    const std::vector<KeyPoint> first = takePoints(in), second = takePoints(in);
    std::vector<DMatch> matches;
    for (int i = in.between(0, 12); i > 0; i--)
    {
        const int query = in.between(0, 15) - 1;
        matches.push_back(DMatch(query, in.between(0, 15) - 1, 0));
    }
    const double angle = estimateRotation(first, second, matches);
    FUZZ_CHECK(angle >= 0 && angle < 360);
}

//! A detector's name, perhaps misspelt.
void scaleFactor(ByteSource& in)
{
    const char* const names[] = {"AKAZE", "Feature2D.ORB", "brisk", "SIFT", "Feature2D.FastFeatureDetector",
            "AgastFeatureDetector", "GFTTDetector", "SimpleBlobDetector", "mser"};
    String name = names[in.between(0, 8)];
    for (int i = in.between(0, 2); i > 0; i--)
        name[in.between(0, (int)name.size() - 1)] = in.take<char>();
    FUZZ_CHECK(IIB::scaleFactorFor(name) > 0);
}

//! Extractors as the detectors of each other: whatever would go in a circle is refused.
void chain(ByteSource& in)
{
    const int count = 4;
    Ptr<IIB> extractors[count];
    std::vector<int> next(count, -1);  // -1: the detector that it was made with
    for (Ptr<IIB>& extractor : extractors)
        extractor = IIB::create();
    for (int i = in.between(0, 9); i > 0; i--)
    {
        const int from = in.between(0, count - 1), to = in.between(0, count - 1);
        bool circle = false, thrown = false;
        for (int at = to; at >= 0; at = next[at])
            circle = circle || at == from;
        try
        {
            extractors[from]->setDetector(extractors[to]);
            next[from] = to;
        }
        catch (const cv::Exception&)
        {
            thrown = true;
        }
        FUZZ_CHECK(thrown == circle);
        FUZZ_CHECK((extractors[from]->getDetector() == Ptr<Feature2D>(extractors[to])) == (next[from] == to));
    }
}

//! detectAndCompute is detect of the detector, then compute.
void detectAndCompute(ByteSource& in)
{
    Ptr<Feature2D> detector = FastFeatureDetector::create(in.between(1, 40));
    if (in.flag())
        detector = NormalizedDetector::create(detector);
    const Ptr<IIB> iib = IIB::createFor(detector, in.between(-2, 8));
    FUZZ_CHECK(iib->getDetector() == detector);
    const Mat image = takeImage(in, takeSize(in), CV_8U, 1);
    std::vector<KeyPoint> expected, keypoints;
    Mat expectedDescriptors, descriptors;
    detector->detect(image, expected);
    std::vector<KeyPoint> detected = expected;
    iib->compute(image, expected, expectedDescriptors);
    iib->detectAndCompute(image, noArray(), keypoints, descriptors);
    FUZZ_CHECK(keypoints.size() == expected.size() && descriptors.size() == expectedDescriptors.size());
    FUZZ_CHECK(descriptors.empty() || cv::norm(descriptors, expectedDescriptors, NORM_INF) == 0);
    iib->detectAndCompute(image, noArray(), detected, descriptors, true);
    FUZZ_CHECK(descriptors.empty() || cv::norm(descriptors, expectedDescriptors, NORM_INF) == 0);
}

void run(ByteSource& in)
{
    switch (in.between(0, 7))
    {
    case 0: scaleFactor(in); break;
    case 1: chain(in); break;
    case 2: detectAndCompute(in); break;
    case 3: rotation(in); break;
    default: normalize(in); break;
    }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const uchar* data, size_t size) { return runTarget(run, data, size); }
