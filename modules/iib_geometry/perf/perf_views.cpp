// SPDX-License-Identifier: Apache-2.0
#include "perf_precomp.hpp"

namespace opencv_test { namespace {

//! The demo's street at noon and at night: from the side, reduced to a quarter and rotated, and another place.
struct Images
{
    explicit Images(const std::string& kind)
        : one(picture("moved_noon")), two(picture(kind == "unrelated" ? "facade_night" : "moved_night"))
    {
        if (kind != "searched")
            return;
        rotate(two, two, ROTATE_90_CLOCKWISE);
        resize(two, two, Size(), .35, .35, INTER_AREA);
    }

    Mat one, two;
};

typedef perf::TestBaseWithParam<std::string> IIB_Views;

PERF_TEST_P(IIB_Views, matchViews, testing::Values("ordinary", "searched", "unrelated"))
{
    const Images images(GetParam());
    Mat points1, points2;
    const Threads one(1);
    TEST_CYCLE()
    ASSERT_EQ(GetParam() != "unrelated",
            matchViews(images.one, images.two, points1, points2, noArray(), noArray(), noArray(), 1000));
    RecordProperty("matches", points1.rows);
    SANITY_CHECK_NOTHING();
}

//! The baseline for an ordinary pair, which needs no search.
PERF_TEST_P(IIB_Views, chain, testing::Values("ordinary"))
{
    const Images images(GetParam());
    const Threads one(1);
    TEST_CYCLE()
    {
        const Ptr<IIB> iib = IIB::createRecommended(1000);
        std::vector<KeyPoint> keypoints1, keypoints2;
        Mat codes1, codes2, points1, points2;
        iib->detectAndCompute(images.one, noArray(), keypoints1, codes1);
        iib->detectAndCompute(images.two, noArray(), keypoints2, codes2);
        std::vector<DMatch> matches;
        HierarchicalMatcher::createRecommended()->match(codes1, codes2, matches);
        propagateMatches(images.one, keypoints1, images.two, keypoints2, matches, points1, points2);
    }
    SANITY_CHECK_NOTHING();
}

//! The baseline for a search.
PERF_TEST_P(IIB_Views, SIFT, testing::Values("searched", "unrelated"))
{
    const Images images(GetParam());
    const Threads one(1);
    TEST_CYCLE()
    {
        const Ptr<SIFT> sift = SIFT::create(1000);
        std::vector<KeyPoint> keypoints1, keypoints2;
        Mat numbers1, numbers2;
        sift->detectAndCompute(images.one, noArray(), keypoints1, numbers1);
        sift->detectAndCompute(images.two, noArray(), keypoints2, numbers2);
        std::vector<DMatch> matches;
        BFMatcher(NORM_L2, true).match(numbers1, numbers2, matches);
    }
    SANITY_CHECK_NOTHING();
}

}}  // namespace opencv_test
