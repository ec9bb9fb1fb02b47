// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#include "perf_precomp.hpp"

namespace opencv_test {
namespace {

// Descriptors of the same 10,000 FAST points in two images of iib_demo, or random ones where it is missing.
struct Pair
{
    Mat queries, trains;
    std::vector<int> levels;

    Pair()
    {
        const Ptr<IIB> iib = IIB::create(IIB::scaleFactorFor("FAST"));
        levels = iib->levelSizes();
        const char* root = getenv("OPENCV_TEST_DATA_PATH");
        const String folder = String(root ? root : "") + "/illumination/iib_demo/scene/";
        const Mat first = imread(folder + "1.png", IMREAD_GRAYSCALE);
        const Mat second = imread(folder + "2.png", IMREAD_GRAYSCALE);
        if (first.empty() || second.empty())
        {
            std::cout << "[          ] No iib_demo below OPENCV_TEST_DATA_PATH: RANDOM descriptors\n";
            queries.create(10000, 170, CV_8U);
            trains.create(10000, 170, CV_8U);
            randu(queries, 0, 256);
            randu(trains, 0, 256);
            return;
        }
        std::vector<KeyPoint> all, points;
        FAST(first, all, 1);
        for (size_t i = 0; i < 10000; i++)
            points.push_back(all[i * all.size() / 10000]);
        iib->compute(first, points, queries);
        iib->compute(second, points, trains);
    }

    static const Pair& get()
    {
        static const Pair pair;
        return pair;
    }
};

enum
{
    BRUTE_FORCE = -1
};
CV_ENUM(Method, BRUTE_FORCE, HierarchicalMatcher::EXACT, HierarchicalMatcher::THRESHOLD,
        HierarchicalMatcher::ADAPTIVE)

Ptr<DescriptorMatcher> createMatcher(int method, const std::vector<int>& levels, bool crossCheck)
{
    if (method == BRUTE_FORCE)
        return BFMatcher::create(NORM_HAMMING, crossCheck);
    return HierarchicalMatcher::create(levels, method, 0.35f, crossCheck);
}

typedef perf::TestBaseWithParam<tuple<Method, bool, int>> IIB_Match;  // method, crossCheck, threads

PERF_TEST_P(IIB_Match, match_10000, testing::Combine(Method::all(), testing::Bool(), testing::Values(1, 2)))
{
    const Pair& pair = Pair::get();
    const Ptr<DescriptorMatcher> matcher = createMatcher(get<0>(GetParam()), pair.levels, get<1>(GetParam()));
    const Threads threads(get<2>(GetParam()));
    std::vector<DMatch> matches;
    declare.time(60);
    TEST_CYCLE() matcher->match(pair.queries, pair.trains, matches);
    SANITY_CHECK_NOTHING();
}

// The points of a video frame against those of the last one.
typedef perf::TestBaseWithParam<tuple<Method, bool, int>> IIB_MatchFrame;  // method, crossCheck, points

PERF_TEST_P(
        IIB_MatchFrame, match, testing::Combine(Method::all(), testing::Bool(), testing::Values(500, 1000)))
{
    const int points = get<2>(GetParam()), step = Pair::get().queries.rows / points;
    Mat queries, trains;
    for (int i = 0; i < points; i++)
    {
        queries.push_back(Pair::get().queries.row(i * step));
        trains.push_back(Pair::get().trains.row(i * step));
    }
    const Ptr<DescriptorMatcher> matcher =
            createMatcher(get<0>(GetParam()), Pair::get().levels, get<1>(GetParam()));
    const Threads one(1);
    std::vector<DMatch> matches;
    TEST_CYCLE() matcher->match(queries, trains, matches);
    SANITY_CHECK_NOTHING();
}

typedef perf::TestBaseWithParam<Method> IIB_MatchTwo;

PERF_TEST_P(IIB_MatchTwo, two_nearest_with_ratio,
        testing::Values((int)BRUTE_FORCE, (int)HierarchicalMatcher::EXACT))
{
    const Pair& pair = Pair::get();
    const Ptr<DescriptorMatcher> matcher = createMatcher(GetParam(), pair.levels, false);
    if (GetParam() != BRUTE_FORCE)
        matcher.dynamicCast<HierarchicalMatcher>()->setMaxRatio(0.8f);
    const Threads one(1);
    std::vector<std::vector<DMatch>> matches;
    declare.time(60);
    TEST_CYCLE() matcher->knnMatch(pair.queries, pair.trains, matches, 2);
    SANITY_CHECK_NOTHING();
}

typedef perf::TestBaseWithParam<tuple<Method, int>> IIB_MatchShort;  // method, bytes

PERF_TEST_P(IIB_MatchShort, match_10000,
        testing::Combine(
                testing::Values((int)BRUTE_FORCE, (int)HierarchicalMatcher::EXACT), testing::Values(32, 64)))
{
    const int bytes = get<1>(GetParam());
    const Mat queries = Pair::get().queries.colRange(0, bytes).clone();
    const Mat trains = Pair::get().trains.colRange(0, bytes).clone();
    const Ptr<DescriptorMatcher> matcher =
            createMatcher(get<0>(GetParam()), std::vector<int>(1, bytes), false);
    const Threads one(1);
    std::vector<DMatch> matches;
    declare.time(60);
    TEST_CYCLE() matcher->match(queries, trains, matches);
    SANITY_CHECK_NOTHING();
}

// A hundredth of the pairs of 1,000 queries against 1,000,000: 10 queries, so that a smoke run stays short.
PERF_TEST(IIB_MatchMany, ten_against_a_million)
{
    Mat trains(1000000, 170, CV_8U), queries(10, 170, CV_8U);
    randu(trains, 0, 256);
    randu(queries, 0, 256);
    const Ptr<HierarchicalMatcher> matcher = HierarchicalMatcher::create(Pair::get().levels);
    matcher->add(trains);
    const Threads one(1);
    std::vector<DMatch> matches;
    TEST_CYCLE() matcher->match(queries, matches);
    SANITY_CHECK_NOTHING();
}

}  // namespace
}  // namespace opencv_test
