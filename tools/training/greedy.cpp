// SPDX-License-Identifier: Apache-2.0

#include <algorithm>
#include <cmath>
#include <map>

#include "select.hpp"

namespace iib_tools {
namespace {

const int ANCHORS_A_PAIR = 100, PAIRS_A_STEP = 40, NEGATIVES = 15;
const float SAME_POINT = 3;  // pixels; the evaluation calls such a match correct

//! The given bits of every row, packed again.
cv::Mat gather(const cv::Mat& descriptors, const std::vector<int>& positions)
{
    cv::Mat packed = cv::Mat::zeros(descriptors.rows, int(positions.size() + 7) / 8, CV_8U);
    for (int row = 0; row < packed.rows; row++)
    {
        const uchar* from = descriptors.ptr(row);
        uchar* to = packed.ptr(row);
        for (size_t i = 0; i < positions.size(); i++)
            to[i / 8] |= uchar((from[positions[i] / 8] >> positions[i] % 8 & 1) << i % 8);
    }
    return packed;
}

//! Adds a weight to the sums of all bits in which two descriptors differ.
void addDifferences(const uchar* a, const uchar* b, int bytes, float weight, std::vector<float>& sums)
{
    static const std::vector<float> masks = [] {
        std::vector<float> table(256 * 8);
        for (int i = 0; i < 256 * 8; i++)
            table[i] = float(i / 8 >> i % 8 & 1);
        return table;
    }();
    for (int i = 0; i < bytes; i++)
    {
        const float* mask = &masks[8 * (a[i] ^ b[i])];
        float* sum = &sums[8 * i];
        for (int k = 0; k < 8; k++)
            sum[k] += weight * mask[k];
    }
}

class Growth
{
public:
    Growth(const CandidatePool& pool_, const std::vector<DescribedPair>& pairs, uint64 seed)
        : pool(pool_), rng(seed)
    {
        std::map<std::string, std::vector<const DescribedPair*>> byScene;
        for (const DescribedPair& pair : pairs)
            if (pair.partners > NEGATIVES)
                byScene[pair.scene].push_back(&pair);
        for (const auto& scene : byScene)
            scenes.push_back(scene.second);
        if (scenes.empty())
            CV_Error(cv::Error::StsBadArg, "no pair has enough points to train on");
    }

    //! The negative derivative of the loss along each candidate, on new anchors.
    std::vector<double> benefits(const std::vector<int>& chosen)
    {
        std::vector<int> positions;
        for (int i : chosen)
            positions.push_back(pool.candidates[i].position);
        if (positions.empty())
            positions.push_back(pool.candidates[0].position);  // any bit, since all points are equally near
        sums.assign(size_t(pool.extractor->descriptorSize()) * 8, 0.f);
        const float temperature = 0.25f * std::sqrt(std::max(float(positions.size()), 24.f));
        for (int i = 0; i < PAIRS_A_STEP; i++)
        {
            const std::vector<const DescribedPair*>& scene = scenes[i % scenes.size()];
            addPair(*scene[rng.uniform(0, int(scene.size()))], positions, temperature);
        }
        std::vector<double> result;
        for (const Candidate& candidate : pool.candidates)
            result.push_back(sums[candidate.position]);
        return result;
    }

private:
    void addPair(const DescribedPair& pair, const std::vector<int>& positions, float temperature)
    {
        const bool forth = rng.uniform(0, 2) == 0;
        const cv::Mat &from = forth ? pair.reference : pair.target,
                      &to = forth ? pair.target : pair.reference;
        const std::vector<cv::Point2f>& points = forth ? pair.targetPoints : pair.referencePoints;
        std::vector<int> anchors(ANCHORS_A_PAIR);
        cv::Mat anchorRows;
        for (int& anchor : anchors)
        {
            anchor = rng.uniform(0, pair.partners);
            anchorRows.push_back(from.row(anchor));
        }
        cv::Mat distances;
        cv::batchDistance(gather(anchorRows, positions), gather(to, positions), distances, CV_32S,
                cv::noArray(), cv::NORM_HAMMING);
        for (int i = 0; i < ANCHORS_A_PAIR; i++)
            addAnchor(points, pair.targetPoints[anchors[i]], from, to, anchors[i], distances.ptr<int>(i),
                    pair.ratio, temperature);
    }

    //! @param points of `to`. @param place position of the anchor.
    void addAnchor(const std::vector<cv::Point2f>& points, cv::Point2f place, const cv::Mat& from,
            const cv::Mat& to, int anchor, const int* distances, float ratio, float temperature)
    {
        std::vector<std::pair<int, int>> others;  // distance with a random tie break, row
        for (int row = 0; row < to.rows; row++)
            if (row != anchor && cv::norm(points[row] - place) > SAME_POINT)
                others.push_back(std::make_pair(distances[row] * 16 + rng.uniform(0, 16), row));
        if (int(others.size()) < NEGATIVES)
            return;
        std::nth_element(others.begin(), others.begin() + NEGATIVES - 1, others.end());

        float odds[NEGATIVES], sum = 0;
        for (int k = 0; k < NEGATIVES; k++)
        {
            odds[k] = std::exp(
                    std::min(60.f, (distances[anchor] - ratio * distances[others[k].second]) / temperature));
            sum += odds[k];
        }
        const float p = 1 / (1 + sum);
        const float slope = p * std::sqrt(p) / temperature;  // derivative of the loss by the odds
        addDifferences(from.ptr(anchor), to.ptr(anchor), from.cols, -slope * sum, sums);
        for (int k = 0; k < NEGATIVES; k++)
            addDifferences(
                    from.ptr(anchor), to.ptr(others[k].second), from.cols, slope * ratio * odds[k], sums);
    }

    const CandidatePool& pool;
    cv::RNG rng;
    std::vector<std::vector<const DescribedPair*>> scenes;
    std::vector<float> sums;  // one for each bit of the pool's descriptor
};

//! Adds at most `count` of the best candidates that are not yet chosen and not neighbours of each other.
void addBest(const CandidatePool& pool, const std::vector<double>& benefits, int count,
        std::vector<bool>& isChosen, std::vector<int>& chosen)
{
    std::vector<int> order, added;
    for (size_t i = 0; i < benefits.size(); i++)
        if (!isChosen[i])
            order.push_back(int(i));
    std::stable_sort(order.begin(), order.end(), [&](int a, int b) { return benefits[a] > benefits[b]; });
    for (int i : order)
    {
        const Candidate& candidate = pool.candidates[i];
        if (int(added.size()) < count && std::none_of(added.begin(), added.end(), [&](int other) {
                return pool.areNeighbours(candidate, pool.candidates[other]);
            }))
        {
            added.push_back(i);
            isChosen[i] = true;
        }
    }
    chosen.insert(chosen.end(), added.begin(), added.end());
}

}  // namespace

std::vector<int> selectGreedily(const CandidatePool& pool, const std::vector<DescribedPair>& pairs, int bits,
        uint64 seed, const Progress& progress)
{
    if (bits < 1 || bits > int(pool.candidates.size()))
        CV_Error(cv::Error::StsOutOfRange,
                cv::format("%d bits are not 1 to %d", bits, int(pool.candidates.size())));
    Growth growth(pool, pairs, seed);
    std::vector<bool> isChosen(pool.candidates.size());
    std::vector<int> chosen;
    while (int(chosen.size()) < bits)
    {
        // a twelfth at a time: with more bits, each step changes distances less
        const int count = std::min(std::max(1, int(chosen.size()) / 12), bits - int(chosen.size()));
        addBest(pool, growth.benefits(chosen), count, isChosen, chosen);
        progress(int(chosen.size()), bits);
    }
    return fillBytes(pool, chosen, growth.benefits(chosen), bits);
}

}  // namespace iib_tools
