// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#include "matcher.hpp"

#ifdef IIB_PERF_VIDEO
#include "opencv2/video/tracking.hpp"
#endif

namespace opencv_test { namespace {

#ifdef IIB_PERF_VIDEO
//! Stores its image.
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
#endif

enum
{
    REFINE,
    OPTICAL_FLOW,       //!< calcOpticalFlowPyrLK on the normalized images: the peer
    DETECT_AND_COMPUTE  //!< of one image, for comparison
};
CV_ENUM(Step, REFINE, OPTICAL_FLOW, DETECT_AND_COMPUTE)

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

typedef perf::TestBaseWithParam<int> IIB_Propagate;  // points

PERF_TEST_P(IIB_Propagate, moved_and_by_night, testing::Values(1000, 2000, 4000))
{
    const PicturePair pair(GetParam());
    std::vector<DMatch> matches;
    Mat points1, points2, covariances;
    const Threads one(1);
    TEST_CYCLE()
    {
        matches = pair.matches;
        propagateMatches(pair.images[0], pair.keypoints[0], pair.images[1], pair.keypoints[1], matches,
                points1, points2, covariances);
    }
    RecordProperty("matches", (int)pair.matches.size());
    RecordProperty("propagated", (int)matches.size());
    SANITY_CHECK_NOTHING();
}

}}  // namespace opencv_test
