// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#include "perf_precomp.hpp"

#ifdef IIB_PERF_VIDEO
#include "opencv2/video/tracking.hpp"
#endif

namespace opencv_test {
namespace {

//! Keeps the image that it is given: the normalized one, if NormalizedDetector asks.
class KeepsImage : public Feature2D
{
public:
    using Feature2D::detect;
    void detect(InputArray image, std::vector<KeyPoint>&, InputArray) CV_OVERRIDE { image.copyTo(kept); }
    Mat kept;
};

Mat normalized(const Mat& image)
{
    const Ptr<KeepsImage> keeper = makePtr<KeepsImage>();
    std::vector<KeyPoint> none;
    NormalizedDetector::create(keeper, 8)->detect(image, none);
    return keeper->kept;
}

enum
{
    REFINE,
    PROPAGATE,          //!< from these matches to those of the other 700 keypoints
    OPTICAL_FLOW,       //!< calcOpticalFlowPyrLK on the normalized images: the peer
    DETECT_AND_COMPUTE  //!< of one of the images: what the time is compared with
};
CV_ENUM(Step, REFINE, PROPAGATE, OPTICAL_FLOW, DETECT_AND_COMPUTE)

typedef perf::TestBaseWithParam<Step> IIB_Refine;

PERF_TEST_P(IIB_Refine, vga_300_matches, Step::all())
{
    Mat image(480, 640, CV_8U), other;
    randu(image, 0, 256);
    GaussianBlur(image, image, Size(7, 7), 1.8);
    image.convertTo(other, CV_8U, .6, 30);
    const Ptr<IIB> iib = IIB::createRecommended(1000);
    std::vector<KeyPoint> keypoints;
    Mat codes;
    iib->detectAndCompute(image, noArray(), keypoints, codes);
    std::vector<DMatch> matches;
    std::vector<Point2f> points, moved;
    std::vector<KeyPoint> starts = keypoints;
    for (int i = 0; i < 300; i++)
    {
        starts[i].pt += Point2f(i % 5 * .2f - .4f, i % 3 * .4f - .4f);
        matches.push_back(DMatch(i, i, 0));
        points.push_back(keypoints[i].pt);
        moved.push_back(starts[i].pt);
    }
    const Threads one(1);
    if (GetParam() == REFINE)
    {
        Mat points1, points2, covariances, similarities;
        TEST_CYCLE()
        refineMatches(image, keypoints, other, starts, matches, points1, points2, covariances, similarities);
    }
    else if (GetParam() == PROPAGATE)
    {
        Mat points1, points2;
        TEST_CYCLE()
        {
            std::vector<DMatch> more = matches;
            propagateMatches(image, keypoints, other, starts, more, points1, points2);
        }
    }
    else if (GetParam() == DETECT_AND_COMPUTE)
        TEST_CYCLE() iib->detectAndCompute(image, noArray(), keypoints, codes);
    else
    {
#ifdef IIB_PERF_VIDEO
        std::vector<uchar> status;
        std::vector<float> errors;
        TEST_CYCLE()
        {
            std::vector<Point2f> found = moved;
            calcOpticalFlowPyrLK(normalized(image), normalized(other), points, found, status, errors,
                    Size(29, 29), 0, TermCriteria(TermCriteria::COUNT + TermCriteria::EPS, 12, .02),
                    OPTFLOW_USE_INITIAL_FLOW);
        }
#else
        throw SkipTestException("built without opencv_video");
#endif
    }
    SANITY_CHECK_NOTHING();
}

}  // namespace
}  // namespace opencv_test
