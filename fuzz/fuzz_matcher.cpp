// SPDX-License-Identifier: Apache-2.0

// HierarchicalMatcher with any level sizes, train images, masks, k, radius and mode: a cv::Exception, or what the
// naive oracle finds.

#include "matches.hpp"
#include "../src/matcher/search.hpp"

#include <numeric>

namespace {

using namespace cv;
using namespace opencv_test;
using cv::iib::HierarchicalMatcher;

//! ADAPTIVE may miss neighbours; what it reports is right and in order.
bool isPartOf(const Matches& some, const MatcherOracle& oracle, const Mat& queries, size_t k)
{
    for (const std::vector<DMatch>& row : some)
    {
        for (size_t i = 0; i < row.size(); i++)
        {
            const DMatch& m = row[i];
            const Mat& image = oracle.images[m.imgIdx];
            if (m.distance != hammingDistance(queries.ptr(m.queryIdx), image.ptr(m.trainIdx), queries.cols) ||
                    (i > 0 && row[i - 1].distance > m.distance))
                return false;
            if (!oracle.masks.empty() && !oracle.masks[m.imgIdx].empty() &&
                    !oracle.masks[m.imgIdx].at<uchar>(m.queryIdx, m.trainIdx))
                return false;
        }
        if (row.size() > k)
            return false;
    }
    return true;
}

int takeRows(ByteSource& in)
{
    // few, since time counts; some beyond a block of 16 codes. Blocks of the search are small, see takeMatcher()
    return in.between(0, in.rarely(16) ? 40 : 7);
}

Mat takeDescriptors(ByteSource& in, int bytes)
{
    Mat descriptors = randomDescriptors(in.take<ushort>(), takeRows(in), bytes);
    for (int i = in.between(0, 4); i > 0 && !descriptors.empty(); i--)
        descriptors.at<uchar>(in.between(0, descriptors.rows - 1), in.between(0, bytes - 1)) =
                in.take<uchar>();
    return descriptors;
}

std::vector<Mat> takeMasks(ByteSource& in, const std::vector<Mat>& images, int queries)
{
    std::vector<Mat> masks;
    const bool wrong = in.between(0, 15) == 15;
    for (size_t i = 0; i < images.size() + wrong * in.between(0, 1); i++)
    {
        const int rows = queries + wrong * in.between(0, 1), cols = i < images.size() ? images[i].rows : 1;
        masks.push_back(in.flag() || rows * cols == 0
                                ? Mat()
                                : randomMask(in.take<uchar>(), rows, cols, in.between(0, 10) / 10.));
        if (wrong && in.flag())
            masks.back().convertTo(masks.back(), CV_32S);
    }
    return masks;
}

bool areValid(const std::vector<Mat>& masks, const std::vector<Mat>& images, int queries)
{
    if (!masks.empty() && masks.size() != images.size())
        return false;
    for (size_t i = 0; i < masks.size(); i++)
        if (!masks[i].empty() &&
                (masks[i].type() != CV_8UC1 || masks[i].size() != Size(images[i].rows, queries)))
            return false;
    return true;
}

Ptr<HierarchicalMatcher> takeMatcher(ByteSource& in, bool wild, MatcherOracle& oracle)
{
    for (int i = in.between(1 - wild, 4); i > 0; i--)
        oracle.levelSizes.push_back(in.between(1 - 2 * wild, in.rarely(8) ? 70 : 9));
    const int mode = in.between(-wild, 2 + wild);
    oracle.crossCheck = in.flag();
    const Ptr<HierarchicalMatcher> matcher = HierarchicalMatcher::create(
            oracle.levelSizes, mode, wild ? in.number() : in.between(0, 64) / 64.f, oracle.crossCheck);
    if (in.flag())
    {
        std::vector<float> thresholds;
        for (size_t i = wild; i < oracle.levelSizes.size(); i++)
            thresholds.push_back(wild ? in.number() : in.between(0, 64) / 64.f);
        if (thresholds.size() > 1)
            thresholds.pop_back();
        if (!thresholds.empty())
            matcher->setThresholds(thresholds);
    }
    oracle.maxRatio = wild ? in.number() : in.between(1, 16) / 16.f;
    matcher->setMaxRatio(oracle.maxRatio);
    // small blocks, so that the few codes of an input cross their boundaries
    cv::iib::ScanBlocks& blocks = dynamic_cast<cv::iib::ScanBlocks&>(*matcher);
    blocks.queryCount = in.between(1, 9);
    blocks.codeBlocks = blocks.codeBlocksOfLimits = in.between(1, 3);
    if (mode == HierarchicalMatcher::THRESHOLD)
        oracle.thresholds = matcher->getThresholds();
    // The oracle knows which part of a last level of more than a word is looked at first.
    if (mode == HierarchicalMatcher::ADAPTIVE && oracle.levelSizes.back() > 4)
        oracle.adaptiveBlock = 16 * blocks.codeBlocksOfLimits;
    return matcher;
}

void checkRadius(HierarchicalMatcher& matcher, const Mat& queries, float radius, MatcherOracle& oracle)
{
    Matches found(3);
    // also for a radius that is no number
    const bool thrown = refused([&] { matcher.radiusMatch(queries, found, radius, oracle.masks); });
    FUZZ_CHECK(thrown == !(radius > FLT_EPSILON));
    if (thrown)
        return;
    oracle.adaptiveBlock = 0;  // radiusMatch is exact
    FUZZ_CHECK(equal(oracle.radius(queries, cvFloor(std::min((double)radius, 8. * queries.cols))), found));
}

void run(ByteSource& in)
{
    MatcherOracle oracle;
    Ptr<HierarchicalMatcher> matcher;
    const bool wild = in.between(0, 7) == 7;  // parameters that may be refused
    if (refused([&] { matcher = takeMatcher(in, wild, oracle); }))
    {
        FUZZ_CHECK(wild);
        return;
    }
    const int width = std::accumulate(oracle.levelSizes.begin(), oracle.levelSizes.end(), 0);
    const Mat queries = takeDescriptors(in, width);
    size_t trains = 0;
    for (int i = in.between(0, 4); i > 0; i--)
    {
        oracle.images.push_back(takeDescriptors(in, width));
        trains += oracle.images.back().rows;
        if (in.flag())
            matcher->add(oracle.images.back());
        else
            matcher->add(std::vector<Mat>(1, oracle.images.back()));
    }
    if (in.flag())
        oracle.masks = takeMasks(in, oracle.images, queries.rows);
    const int k = in.rarely(16) ? INT_MAX : in.between(1, 20);
    const float radius = in.number();
    const bool compact = in.flag(), wrongWidth = in.between(0, 31) == 31;
    useThreads(in.rarely(128) ? 3 : 1);

    Matches found(2), again;
    const bool thrown = refused([&] {
        matcher->knnMatch(
                wrongWidth ? Mat(3, width + 1, CV_8U, Scalar(1)) : queries, found, k, oracle.masks, compact);
    });
    if (queries.empty() || trains == 0)
        return;  // DescriptorMatcher has returned before asking
    FUZZ_CHECK(thrown == (wrongWidth || !areValid(oracle.masks, oracle.images, queries.rows)));
    if (thrown)
        return;

    // ADAPTIVE has nothing to go by in a single small level
    const bool known = matcher->getMode() != HierarchicalMatcher::ADAPTIVE || oracle.adaptiveBlock > 0 ||
                       (oracle.levelSizes.size() == 1 && width <= 4);
    if (known)
    {
        Matches expected = oracle.knn(queries, k);
        if (compact)
            expected.erase(std::remove_if(expected.begin(), expected.end(),
                                   [](const std::vector<DMatch>& row) { return row.empty(); }),
                    expected.end());
        FUZZ_CHECK(equal(expected, found));
    }
    FUZZ_CHECK(isPartOf(found, oracle, queries, k));
    const double cost = matcher->matchCost();
    FUZZ_CHECK(cost >= 0 && cost <= 1);
    if (in.flag())
        return checkRadius(*matcher, queries, radius, oracle);
    matcher->clone(false)->knnMatch(queries, again, k, oracle.masks, compact);
    FUZZ_CHECK(equal(found, again));
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const uchar* data, size_t size) { return runTarget(run, data, size); }
