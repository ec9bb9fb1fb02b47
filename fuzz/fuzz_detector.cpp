// SPDX-License-Identifier: Apache-2.0

// NormalizedDetector with any image and sigma: expects a cv::Exception, or that the inner detector gets the image of
// the naive oracle. estimateRotation and matchRotated with any arguments: a cv::Exception or an angle. Detectors of
// extractors: a cv::Exception, or keypoints with descriptors.

#include "images.hpp"
#include "detector/hessian_oracle.hpp"
#include "normalization/normalization_oracle.hpp"
#include "normalization/seen_image.hpp"

#include <cmath>

namespace {

using namespace fuzz;
using namespace opencv_test;

void normalize(ByteSource& in)
{
    const bool wild = in.between(0, 7) == 7, odd = in.between(0, 15) == 15;
    const float sigma = wild ? in.number() : 1 + in.between(0, in.rarely(16) ? 1000 : 60) / 4.f;
    const Mat image = drawImage(in, drawSize(in), odd);
    useThreads(in.rarely(128) ? 3 : 1);

    const Ptr<CaptureDetector> capture = makePtr<CaptureDetector>();
    const bool validSigma = sigma >= 1 && sigma <= 256;
    std::vector<KeyPoint> keypoints(2);
    const bool thrown =
            refused([&] { NormalizedDetector::create(capture, sigma)->detect(image, keypoints); });
    FUZZ_CHECK(thrown == (!validSigma || (!image.empty() && !isImage(image))));
    if (thrown || image.empty())
        return;
    FUZZ_CHECK(keypoints.empty() && capture->seen.size() == image.size() && capture->seen.type() == CV_8U);
    if (image.channels() == 1 && image.depth() != CV_32F)
        FUZZ_CHECK(cv::norm(oracle::normalizeLocally(image, sigma), capture->seen, NORM_INF) == 0);
}

//! HessianDetector must find the oracle's keypoints, for any image and parameters.
void blobs(ByteSource& in)
{
    const Ptr<HessianDetector> detector = HessianDetector::create(in.between(0, 40), in.between(0, 9) / 100.f,
            in.between(1, 8), in.between(15, 80) / 10.f, (float)in.between(2, 40));
    const Mat image = drawImage(in, drawSize(in), in.flag() ? CV_8U : CV_16U, 1);
    std::vector<KeyPoint> keypoints;
    detector->detect(image, keypoints);
    const bool tooSmall = image.rows < 2 || image.cols < 2;
    const std::vector<KeyPoint> expected =
            tooSmall ? std::vector<KeyPoint>() : oracle::findBlobs(image, *detector);
    FUZZ_CHECK(keypoints.size() == expected.size());
    for (size_t i = 0; i < expected.size(); i++)
        FUZZ_CHECK(keypoints[i].pt == expected[i].pt && keypoints[i].size == expected[i].size &&
                   keypoints[i].response == expected[i].response &&
                   keypoints[i].octave == expected[i].octave);
}

std::vector<Point2f> drawPoints(ByteSource& in)
{
    std::vector<Point2f> points(in.between(0, 12));
    for (Point2f& point : points)
    {
        point.x = in.number();
        point.y = in.number();
    }
    return points;
}

bool isFinite(const Point2f& point) { return std::isfinite(point.x) && std::isfinite(point.y); }

//! Any points and matches: expects an angle if two matches differ in both images, and only if all points are finite.
void rotation(ByteSource& in)
{
    const std::vector<Point2f> first = drawPoints(in), second = drawPoints(in);
    std::vector<KeyPoint> keypoints[2];
    KeyPoint::convert(first, keypoints[0]);
    KeyPoint::convert(second, keypoints[1]);
    std::vector<DMatch> matches(in.between(0, 12));
    bool finite = true, apart = false;
    for (DMatch& m : matches)
    {
        m.queryIdx = in.between(-1, 14);
        m.trainIdx = in.between(-1, 14);
        finite = finite && m.queryIdx >= 0 && m.queryIdx < (int)first.size() && m.trainIdx >= 0 &&
                 m.trainIdx < (int)second.size() && isFinite(first[m.queryIdx]) &&
                 isFinite(second[m.trainIdx]);
    }
    for (const DMatch& a : matches)
        for (const DMatch& b : matches)
            apart = apart || (finite && first[a.queryIdx] != first[b.queryIdx] &&
                                     second[a.trainIdx] != second[b.trainIdx]);
    double angle = 0;
    const bool thrown = refused([&] { angle = estimateRotation(keypoints[0], keypoints[1], matches); });
    FUZZ_CHECK(thrown ? !apart : finite && angle >= 0 && angle < 360);
}

//! Any images and keypoints; most are accepted.
void matchImages(ByteSource& in)
{
    static Ptr<IIB> presets[10];  // reused, since creation takes longer than matching
    Ptr<IIB>& iib = presets[in.between(0, 9)];
    if (!iib)
        iib = IIB::createPreset((int)(&iib - presets), 2.f);
    iib->setOrientation(IIB::ORIENTATION_KEYPOINT);
    iib->setBorder(in.between(0, 2));
    Mat images[2];
    std::vector<KeyPoint> keypoints[2];
    for (int i = 0; i < 2; i++)
    {
        const Size size = drawSize(in);
        images[i] = drawImage(in, size, drawDepth(in), 1);
        for (int k = in.between(0, 12); k > 0; k--)
        {
            const float x = in.rarely(64) ? in.number() : (float)in.between(0, size.width);
            const float y = (float)in.between(0, size.height);
            keypoints[i].push_back(KeyPoint(x, y, 1.f + in.between(0, 40)));
        }
    }
    std::vector<DMatch> matches;
    double rotation = 0;
    const bool thrown = refused([&] {
        rotation = matchRotated(images[0], keypoints[0], images[1], keypoints[1], iib,
                HierarchicalMatcher::createRecommended(), matches);
    });
    FUZZ_CHECK(thrown || (rotation >= 0 && rotation < 360));
    for (const DMatch& m : matches)
        FUZZ_CHECK(m.queryIdx < (int)keypoints[0].size() && m.trainIdx < (int)keypoints[1].size());
}

//! detectAndCompute must equal the detector's detect, then compute.
void detectAndCompute(ByteSource& in)
{
    Ptr<Feature2D> detector = FastFeatureDetector::create(in.between(1, 40));
    if (in.flag())
        detector = NormalizedDetector::create(detector);
    const int preset = in.between(-2, 8);
    Ptr<IIB> iib;
    FUZZ_CHECK(refused([&] { iib = IIB::createFor(detector, preset); }) == (preset < -1));
    if (!iib)
        return;
    FUZZ_CHECK(iib->getDetector() == detector);
    const Size size = drawSize(in);
    const Mat image = drawImage(in, size, drawDepth(in), 1);
    std::vector<KeyPoint> expected, keypoints;
    Mat expectedDescriptors, descriptors;
    FUZZ_CHECK(refused([&] { iib->detect(image, expected); }) == !isImage(image));
    if (!isImage(image))
        return;
    if (image.depth() == CV_8U)  // FAST accepts no other type
        detector->detect(image, expected);
    std::vector<KeyPoint> detected = expected;
    iib->compute(image, expected, expectedDescriptors);
    iib->detectAndCompute(image, noArray(), keypoints, descriptors);
    FUZZ_CHECK(keypoints.size() == expected.size() && descriptors.size() == expectedDescriptors.size());
    FUZZ_CHECK(descriptors.empty() || cv::norm(descriptors, expectedDescriptors, NORM_INF) == 0);
    iib->detectAndCompute(image, noArray(), detected, descriptors, true);
    FUZZ_CHECK(descriptors.empty() || cv::norm(descriptors, expectedDescriptors, NORM_INF) == 0);
}

}  // namespace

FUZZ_TARGET
{
    switch (in.between(0, 6))
    {
    case 0: matchImages(in); break;
    case 1: blobs(in); break;
    case 2: detectAndCompute(in); break;
    case 3: rotation(in); break;
    default: normalize(in); break;
    }
}
