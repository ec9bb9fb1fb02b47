// SPDX-License-Identifier: Apache-2.0

#include <algorithm>
#include <cmath>

#include "select.hpp"

namespace iib_tools {
namespace {

const int MOST_POSITIVES = 20000, MOST_BITS = 8;

//! Distances of every candidate on every sample; the first half of the samples are partners.
struct Samples
{
    int count;
    cv::Mat_<uchar> distances;  //!< a row a candidate
};

Samples drawSamples(const CandidatePool& pool, const std::vector<DescribedPair>& pairs, uint64 seed)
{
    cv::RNG rng(seed);
    std::vector<std::pair<const uchar*, const uchar*>> rows, negatives;
    const int perPair = std::max(1, MOST_POSITIVES / int(pairs.size()));
    for (const DescribedPair& pair : pairs)
        for (int i = 0; i < std::min(perPair, pair.partners); i++)
        {
            const int point = rng.uniform(0, pair.partners);
            const int other = (point + rng.uniform(1, pair.target.rows)) % pair.target.rows;
            rows.push_back(std::make_pair(pair.reference.ptr(point), pair.target.ptr(point)));
            negatives.push_back(std::make_pair(pair.reference.ptr(point), pair.target.ptr(other)));
        }
    rows.insert(rows.end(), negatives.begin(), negatives.end());

    Samples samples = {int(rows.size()), cv::Mat_<uchar>(int(pool.candidates.size()), int(rows.size()))};
    for (size_t c = 0; c < pool.candidates.size(); c++)
        for (int s = 0; s < samples.count; s++)
        {
            uchar distance = 0;
            for (int position : pool.candidates[c].positions)
                distance += uchar(
                        (rows[s].first[position / 8] ^ rows[s].second[position / 8]) >> position % 8 & 1);
            samples.distances(int(c), s) = distance;
        }
    return samples;
}

//! A weak learner: "same" if the candidate's distance is at most `threshold`.
struct Weak
{
    int candidate, threshold;
    double error;  // weighted, of all samples
};

/* A learner that says the same of all samples is none: where partners weigh less than others, "other" throughout errs
 seldom, and would let in any candidate, the worst too. */
Weak bestThreshold(const Samples& samples, const std::vector<double>& weights, int candidate, int bits)
{
    double same[MOST_BITS + 1] = {}, other[MOST_BITS + 1] = {};
    const uchar* distances = samples.distances[candidate];
    for (int s = 0; s < samples.count; s++)
        (s < samples.count / 2 ? same : other)[distances[s]] += weights[s];
    double error = 0;
    for (double weight : same)
        error += weight;
    Weak best = {candidate, -1, 2};
    for (int threshold = 0; threshold < bits; threshold++)
    {
        error += other[threshold] - same[threshold];
        if (error < best.error)
            best = {candidate, threshold, error};
    }
    return best;
}

void reweigh(const Samples& samples, const Weak& weak, std::vector<double>& weights)
{
    const double error = std::min(std::max(weak.error, 1e-9), 0.5);
    for (int s = 0; s < samples.count; s++)
    {
        const bool says = samples.distances(weak.candidate, s) <= weak.threshold, is = s < samples.count / 2;
        weights[s] *= 0.5 / (says == is ? 1 - error : error);  // the sum stays 1
    }
}

}  // namespace

std::vector<int> selectByAdaBoost(const CandidatePool& pool, const std::vector<DescribedPair>& pairs,
        int bits, uint64 seed, const Progress& progress)
{
    const int wanted = candidateCount(pool, bits);
    if (pairs.empty())
        CV_Error(cv::Error::StsBadArg, "no pair has enough points to train on");
    const Samples samples = drawSamples(pool, pairs, seed);
    const int all = int(pool.candidates.size());
    std::vector<double> weights(samples.count, 1. / samples.count), benefit(all);
    std::vector<bool> isChosen(all);
    std::vector<int> chosen;
    for (;;)
    {
        Weak best = {-1, -1, 2};
        for (int c = 0; c < all; c++)
            if (!isChosen[c])
            {
                const Weak weak = bestThreshold(samples, weights, c, pool.bitsPerCandidate());
                benefit[c] = 0.5 - weak.error;
                if (weak.error < best.error)
                    best = weak;
            }
        if (int(chosen.size()) == wanted)
            return fillBytes(pool, chosen, benefit, bits);
        reweigh(samples, best, weights);
        isChosen[best.candidate] = true;
        chosen.push_back(best.candidate);
        progress(int(chosen.size()), wanted);
    }
}

}  // namespace iib_tools
