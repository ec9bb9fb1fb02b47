// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#include "../support/matcher_oracle.hpp"
#include "../support/describe.hpp"

/* The matcher on descriptors of real images, below OPENCV_TEST_DATA_PATH; without them these tests skip. */
namespace opencv_test { namespace {

//! The default descriptor of the same FAST points in two images of a still camera.
struct RealPair
{
    std::vector<KeyPoint> keypoints;
    std::vector<int> levels;
    Mat queries, trains;

    RealPair(int second, size_t count)
    {
        const Mat images[] = {readIllumination("iib_demo/scene/1.png"),
                readIllumination(format("iib_demo/scene/%d.png", second))};
        std::vector<KeyPoint> all;
        FAST(images[0], all, 1);
        for (size_t i = 0; i < count; i++)
            keypoints.push_back(all[i * all.size() / count]);
        const Ptr<IIB> iib = IIB::create(IIB::scaleFactorFor("FAST"));
        levels = iib->levelSizes();
        iib->compute(images[0], keypoints, queries);
        iib->compute(images[1], keypoints, trains);
    }

    //! The train code of each query within 3 pixels, or -1.
    std::vector<int> correct(const Ptr<HierarchicalMatcher>& matcher) const
    {
        std::vector<DMatch> matches;
        matcher->match(queries, trains, matches);
        std::vector<int> result(queries.rows, -1);
        for (const DMatch& m : matches)
            if (cv::norm(keypoints[m.queryIdx].pt - keypoints[m.trainIdx].pt) <= 3)
                result[m.queryIdx] = m.trainIdx;
        return result;
    }
};

TEST(IIB_Real, threshold_is_the_papers_rule)
{
    const RealPair pair(2, 600);
    MatcherOracle oracle;
    oracle.levelSizes = pair.levels;
    oracle.images.push_back(pair.trains);
    for (float threshold : {0.25f, 0.35f, 0.45f, 0.6f})
    {
        oracle.thresholds.assign(3, threshold);
        const Ptr<HierarchicalMatcher> matcher = oracle.matcher();
        expectKnnAsOracle(*matcher, oracle, pair.queries, 2);
        if (threshold == 0.35f)
        {
            EXPECT_LE(matcher->matchCost(), 0.07);
        }
    }
}

// ADAPTIVE's margin was tuned on other images.
TEST(IIB_Real, adaptive_keeps_the_correct_matches)
{
    for (int second : {2, 3})
        for (bool crossCheck : {false, true})
        {
            const RealPair pair(second, 10000);
            const std::vector<int> exact = pair.correct(
                    HierarchicalMatcher::create(pair.levels, HierarchicalMatcher::EXACT, 0.35f, crossCheck));
            const Ptr<HierarchicalMatcher> matcher = HierarchicalMatcher::create(
                    pair.levels, HierarchicalMatcher::ADAPTIVE, 0.35f, crossCheck);
            const std::vector<int> adaptive = pair.correct(matcher);
            int all = 0, kept = 0;
            for (size_t i = 0; i < exact.size(); i++)
            {
                all += exact[i] >= 0;
                kept += exact[i] >= 0 && adaptive[i] == exact[i];
            }
            std::cout << format("[          ] 1 - %d, cross-check %d: %d of %d, MC %.3f\n", second,
                    crossCheck, kept, all, matcher->matchCost());
            EXPECT_GE(kept, 0.98 * all);
            EXPECT_LE(matcher->matchCost(), 0.5);
        }
}

}}  // namespace opencv_test
