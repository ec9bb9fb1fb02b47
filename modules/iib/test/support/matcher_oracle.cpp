// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#include "matcher_oracle.hpp"

namespace opencv_test {

Mat randomMask(uint64 seed, int rows, int cols, double share)
{
    RNG rng(seed);
    Mat values(rows, cols, CV_64F);
    rng.fill(values, RNG::UNIFORM, 0, 1);
    return values < share;
}

// Relative distance of a float from its decimal number.
static const double EPSILON = 1. / (1 << 23);

bool MatcherOracle::passes(const uchar* query, const uchar* train)
{
    for (size_t level = 0; level < levelSizes.size(); level++)
    {
        const int bits = 8 * levelSizes[level];
        compared += bits;
        if (level < thresholds.size() &&
                hammingDistance(query, train, levelSizes[level]) > thresholds[level] * (1 + EPSILON) * bits)
            return false;
        query += levelSizes[level];
        train += levelSizes[level];
    }
    return true;
}

// The bytes that ADAPTIVE compares first: all levels but the last, and every fourth word of the last.
static std::vector<int> sampledBytes(const std::vector<int>& levelSizes)
{
    std::vector<int> bytes;
    int begin = 0;
    for (size_t level = 0; level < levelSizes.size(); begin += levelSizes[level++])
        for (int i = 0; i < levelSizes[level]; i++)
            if (level + 1 < levelSizes.size() || i / 4 % 4 == 0)
                bytes.push_back(begin + i);
    return bytes;
}

// Drops the pairs whose partial distance exceeds the query's least so far by more than 1.75 sigma, a block of train codes at
// a time.
void MatcherOracle::keepAdaptive(const Mat& queries, Matches& found)
{
    const std::vector<int> bytes = sampledBytes(levelSizes);
    const int margin = cvRound(1.75 * std::sqrt(8. * bytes.size()) / 2);
    std::vector<int> starts(1, 0);
    for (size_t i = 0; i < images.size(); i++)
        starts.push_back(starts.back() + images[i].rows);
    compared = all;  // less the rest of dropped pairs
    for (size_t q = 0; q < found.size(); q++)
    {
        std::vector<DMatch> kept;
        int least = INT_MAX - margin, block = -1;
        for (size_t i = 0; i < found[q].size();)
        {
            std::vector<int> partial;
            block = (starts[found[q][i].imgIdx] + found[q][i].trainIdx) / adaptiveBlock;
            size_t end = i;
            for (; end < found[q].size(); end++)
            {
                const DMatch& m = found[q][end];
                if ((starts[m.imgIdx] + m.trainIdx) / adaptiveBlock != block)
                    break;
                int distance = 0;
                for (int b : bytes)
                    distance +=
                            hammingDistance(queries.ptr((int)q) + b, images[m.imgIdx].ptr(m.trainIdx) + b, 1);
                partial.push_back(distance);
                least = std::min(least, distance);
            }
            for (size_t p = 0; p < partial.size(); p++)
                if (partial[p] <= least + margin)
                    kept.push_back(found[q][i + p]);
                else
                    compared -= 8. * (queries.cols - (double)bytes.size());
            i = end;
        }
        found[q] = kept;
    }
}

static bool nearer(const DMatch& a, const DMatch& b)
{
    if (a.distance != b.distance)
        return a.distance < b.distance;
    return a.imgIdx != b.imgIdx ? a.imgIdx < b.imgIdx : a.trainIdx < b.trainIdx;
}

Matches MatcherOracle::candidates(const Mat& queries)
{
    Matches result(queries.rows);
    for (int q = 0; q < queries.rows; q++)
        for (int image = 0; image < (int)images.size(); image++)
            for (int t = 0; t < images[image].rows; t++)
            {
                if (!masks.empty() && !masks[image].empty() && !masks[image].at<uchar>(q, t))
                    continue;
                all += 8 * queries.cols;
                if (passes(queries.ptr(q), images[image].ptr(t)))
                    result[q].push_back(DMatch(q, t, image,
                            (float)hammingDistance(queries.ptr(q), images[image].ptr(t), queries.cols)));
            }
    if (adaptiveBlock > 0)
        keepAdaptive(queries, result);
    for (size_t q = 0; q < result.size(); q++)
        std::sort(result[q].begin(), result[q].end(), nearer);
    return result;
}

Matches MatcherOracle::knn(const Mat& queries, int k)
{
    Matches result = candidates(queries);
    // of each train descriptor: (distance, query)
    std::map<std::pair<int, int>, std::vector<std::pair<float, int>>> backwards;
    for (size_t q = 0; q < result.size(); q++)
        for (size_t i = 0; i < result[q].size(); i++)
            backwards[std::make_pair(result[q][i].imgIdx, result[q][i].trainIdx)].push_back(
                    std::make_pair(result[q][i].distance, (int)q));
    for (size_t q = 0; q < result.size(); q++)
    {
        std::vector<DMatch>& row = result[q];
        if (maxRatio < 1 && row.size() > 1 && !(row[0].distance < maxRatio * (1 - EPSILON) * row[1].distance))
            row.clear();
        row.resize(std::min(row.size(), (size_t)k));
        if (crossCheck)
            row.erase(std::remove_if(row.begin(), row.end(),
                              [&](const DMatch& m) {
                                  std::vector<std::pair<float, int>> back =
                                          backwards[std::make_pair(m.imgIdx, m.trainIdx)];
                                  std::sort(back.begin(), back.end());
                                  back.resize(std::min(back.size(), (size_t)k));
                                  return std::find(back.begin(), back.end(),
                                                 std::make_pair(m.distance, (int)q)) == back.end();
                              }),
                    row.end());
    }
    return result;
}

Matches MatcherOracle::radius(const Mat& queries, int radius)
{
    Matches result = candidates(queries);
    for (size_t q = 0; q < result.size(); q++)
        while (!result[q].empty() && result[q].back().distance > radius)
            result[q].pop_back();
    return result;
}

Ptr<HierarchicalMatcher> MatcherOracle::matcher() const
{
    const int mode = !thresholds.empty() ? HierarchicalMatcher::THRESHOLD
                     : adaptiveBlock > 0 ? HierarchicalMatcher::ADAPTIVE
                                         : HierarchicalMatcher::EXACT;
    const Ptr<HierarchicalMatcher> result = HierarchicalMatcher::create(
            levelSizes, mode, thresholds.empty() ? 0.35f : thresholds[0], crossCheck);
    result->setMaxRatio(maxRatio);
    result->add(images);
    return result;
}

MatcherOracle oracleOfSeveralImages()
{
    MatcherOracle oracle;
    oracle.levelSizes = {2, 8, 32};
    const int rows[] = {70, 0, 1, 37, 200};
    for (int i = 0; i < 5; i++)
        oracle.images.push_back(randomDescriptors(10 + i, rows[i], 42));
    return oracle;
}

std::vector<Mat> masksOfSeveralImages(const MatcherOracle& oracle, int queries)
{
    std::vector<Mat> masks;
    for (int i = 0; i < 5; i++)
        masks.push_back(i == 1 || i == 2 ? Mat() : randomMask(30 + i, queries, oracle.images[i].rows, 0.5));
    return masks;
}

void expectEqual(const Matches& expected, const Matches& actual)
{
    ASSERT_EQ(expected.size(), actual.size());
    for (size_t q = 0; q < expected.size(); q++)
    {
        ASSERT_EQ(expected[q].size(), actual[q].size()) << "query " << q;
        for (size_t i = 0; i < expected[q].size(); i++)
        {
            const DMatch &e = expected[q][i], &a = actual[q][i];
            ASSERT_EQ(e.distance, a.distance) << "query " << q << ", neighbour " << i;
            ASSERT_EQ(std::make_pair(e.imgIdx, e.trainIdx), std::make_pair(a.imgIdx, a.trainIdx))
                    << "query " << q << ", neighbour " << i;
            ASSERT_EQ(e.queryIdx, a.queryIdx);
        }
    }
}

void expectSameParameters(const HierarchicalMatcher& a, const HierarchicalMatcher& b)
{
    EXPECT_EQ(a.levelSizes(), b.levelSizes());
    EXPECT_EQ(a.getMode(), b.getMode());
    EXPECT_EQ(a.getThresholds(), b.getThresholds());
    EXPECT_EQ(a.getCrossCheck(), b.getCrossCheck());
    EXPECT_EQ(a.getMaxRatio(), b.getMaxRatio());
}

void expectKnnAsOracle(HierarchicalMatcher& matcher, MatcherOracle& oracle, const Mat& queries, int k)
{
    Matches actual;
    matcher.knnMatch(queries, actual, k, oracle.masks);
    oracle.compared = oracle.all = 0;
    expectEqual(oracle.knn(queries, k), actual);
    EXPECT_EQ(oracle.compared / oracle.all, matcher.matchCost());
}

Matches searched(const MatcherOracle& oracle, const Mat& queries, int k, int radius, const ScanChunk& chunk,
        SearchCost& cost)
{
    const PackedCodes trains(oracle.levelSizes, oracle.images);
    const CodeLayout& layout = trains.layout();
    const PruningPolicy policy = !oracle.thresholds.empty() ? thresholdPolicy(layout, oracle.thresholds)
                                 : k == 0                   ? radiusPolicy(layout, radius)
                                 : oracle.adaptiveBlock > 0 ? adaptivePolicy(layout)
                                                            : PruningPolicy();
    const SearchInput input = {
            trains, queries, policy, checkedMasks(oracle.masks, queries.rows, trains), {}, 0, chunk, cost};
    Matches matches(queries.rows);
    const auto append = [&](int query, MatchKey n) {
        const size_t image = trains.imageOf(indexOf(n));
        const int row = (int)(indexOf(n) - trains.start(image));
        matches[query].push_back(DMatch(query, row, (int)image, (float)distanceOf(n)));
    };
    if (k == 0)
    {
        const std::vector<std::vector<MatchKey>> found = findWithin(input, radius);
        for (int query = 0; query < queries.rows; query++)
            for (MatchKey n : found[query])
                append(query, n);
        return matches;
    }
    const KnnTable found = findNearest(input, k, oracle.crossCheck, oracle.maxRatio);
    for (int query = 0; query < queries.rows; query++)
        for (int i = 0; i < found.size() && found[query][i] != NO_MATCH; i++)
            append(query, found[query][i]);
    return matches;
}

}  // namespace opencv_test
