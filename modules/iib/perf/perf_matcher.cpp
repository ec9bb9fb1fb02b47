// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#include "matcher.hpp"

#include <numeric>

namespace opencv_test { namespace {

//! Descriptors of 10,000 points in a large image, and in a darker one with a ramp and noise.
struct Codes
{
    Mat queries, trains;

    Codes()
    {
        const Mat image = cornerImage(Size(2560, 1440));
        Mat ramp(1, image.cols, CV_32F), relit, noise(image.size(), CV_32F);
        for (int x = 0; x < image.cols; x++)
            ramp.at<float>(x) = 0.3f + 0.5f * float(x) / float(image.cols);
        image.convertTo(relit, CV_32F);
        RNG(4).fill(noise, RNG::NORMAL, 0, 6);
        relit = relit.mul(repeat(ramp, image.rows, 1)) + noise;
        relit.convertTo(relit, CV_8U);
        std::vector<KeyPoint> keypoints = corners(image, 10000);
        const Ptr<IIB> iib = IIB::create();
        iib->compute(image, keypoints, trains);
        iib->compute(relit, keypoints, queries);
    }

    static const Codes& get()
    {
        static const Codes codes;
        return codes;
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

class IIB_Match
    : public perf::TestBaseWithParam<tuple<Method, bool, int>>  // method, crossCheck, codes on either side
{
protected:
    void time(const std::vector<int>& levels, int threads)
    {
        const int count = get<2>(GetParam());
        const Ptr<DescriptorMatcher> matcher = createMatcher(get<0>(GetParam()), levels, get<1>(GetParam()));
        const Rect part(0, 0, std::accumulate(levels.begin(), levels.end(), 0), count);
        const Mat queries = Codes::get().queries(part).clone(), trains = Codes::get().trains(part).clone();
        std::vector<DMatch> matches;
        const Threads some(threads);
        TEST_CYCLE() matcher->match(queries, trains, matches);
        SANITY_CHECK_NOTHING();
    }
};

PERF_TEST_P(IIB_Match, match,
        testing::Combine(Method::all(), testing::Bool(), testing::Values(1, 100, 500, 1000, 5000, 10000)))
{
    time(IIB::create()->levelSizes(), 1);
}

PERF_TEST_P(IIB_Match, on_two_threads,
        testing::Combine(testing::Values((int)HierarchicalMatcher::EXACT), testing::Values(true),
                testing::Values(5000)))
{
    time(IIB::create()->levelSizes(), 2);
}

PERF_TEST_P(IIB_Match, of_32_bytes,
        testing::Combine(testing::Values((int)BRUTE_FORCE, (int)HierarchicalMatcher::EXACT),
                testing::Values(false), testing::Values(500, 10000)))
{
    time(std::vector<int>(1, 32), 1);
}

// Mutual matches under a ratio test, of descriptors of 128 bytes.
typedef perf::TestBaseWithParam<tuple<Method, int>> IIB_MatchPair;  // method, points

PERF_TEST_P(IIB_MatchPair, mutual_and_ratio,
        testing::Combine(testing::Values((int)BRUTE_FORCE, (int)HierarchicalMatcher::EXACT),
                testing::Values(1000, 2000, 4000)))
{
    const PicturePair pair(get<1>(GetParam()));
    const Mat &queries = pair.codes[0], &trains = pair.codes[1];
    std::vector<DMatch> matches, back;
    std::vector<std::vector<DMatch>> two;
    const Threads one(1);
    if (get<0>(GetParam()) != BRUTE_FORCE)
    {
        const Ptr<HierarchicalMatcher> matcher = HierarchicalMatcher::createRecommended();
        TEST_CYCLE() matcher->match(queries, trains, matches);
    }
    else
        TEST_CYCLE()  // BFMatcher has no cross-check of two nearest ones
        {
            two.clear();  // BFMatcher appends
            back.clear();
            const BFMatcher matcher(NORM_HAMMING);
            matcher.knnMatch(queries, trains, two, 2);
            matcher.match(trains, queries, back);
            matches.clear();
            for (const std::vector<DMatch>& m : two)
                if (m[0].distance < .92f * m[1].distance && back[m[0].trainIdx].trainIdx == m[0].queryIdx)
                    matches.push_back(m[0]);
        }
    EXPECT_EQ(pair.matches.size(), matches.size());
    SANITY_CHECK_NOTHING();
}

// One video frame, 640 x 480, two threads: describes 1000 ORB keypoints and matches them with the previous frame's.
typedef perf::TestBaseWithParam<std::string> IIB_Frame;

PERF_TEST_P(IIB_Frame, vga, testing::Values("ORB", "default"))
{
    const bool peer = GetParam() == "ORB";
    const Mat image = cornerImage(Size(640, 480));
    const Ptr<ORB> orb = ORB::create(1000);
    const Ptr<Feature2D> feature = peer ? Ptr<Feature2D>(orb) : Ptr<Feature2D>(IIB::createFor(orb));
    const Ptr<DescriptorMatcher> matcher = createMatcher(
            peer ? BRUTE_FORCE : (int)HierarchicalMatcher::EXACT, IIB::create()->levelSizes(), true);
    std::vector<KeyPoint> keypoints;
    Mat last, codes;
    orb->detect(image, keypoints);
    feature->compute(image, keypoints, last);
    std::vector<DMatch> matches;
    const Threads two(2);
    TEST_CYCLE()
    {
        feature->compute(image, keypoints, codes);
        matcher->match(codes, last, matches);
    }
    SANITY_CHECK_NOTHING();
}

// A hundredth of the pairs of 1,000 queries against 1,000,000: 10 queries, so that a smoke run stays short.
PERF_TEST(IIB_MatchMany, ten_against_a_million)
{
    const Ptr<IIB> iib = IIB::create();
    Mat trains(1000000, iib->descriptorSize(), CV_8U), queries(10, trains.cols, CV_8U);
    randu(trains, 0, 256);
    randu(queries, 0, 256);
    const Ptr<HierarchicalMatcher> matcher = HierarchicalMatcher::create(iib->levelSizes());
    matcher->add(trains);
    const Threads one(1);
    std::vector<DMatch> matches;
    TEST_CYCLE() matcher->match(queries, matches);
    SANITY_CHECK_NOTHING();
}

}}  // namespace opencv_test
