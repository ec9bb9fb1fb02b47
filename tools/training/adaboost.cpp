// SPDX-License-Identifier: Apache-2.0

#include <algorithm>

#include "select.hpp"

namespace iib_tools {
namespace {

const int MOST_POSITIVES = 20000, BITS_A_QUAD = 4;

//! Number of differing bits of each quad in each sample; the first half of the samples are partners.
struct Samples
{
    int count;
    cv::Mat_<uchar> distances;  //!< one row a quad
};

Samples drawSamples(const CandidatePool& pool, const std::vector<DescribedPair>& pairs, uint64 seed)
{
    cv::RNG rng(seed);
    std::vector<std::pair<const uchar*, const uchar*>> rows, others;
    const int perPair = std::max(1, MOST_POSITIVES / int(pairs.size()));
    for (const DescribedPair& pair : pairs)
        for (int i = 0; i < std::min(perPair, pair.partners); i++)
        {
            const int point = rng.uniform(0, pair.partners);
            const int other = (point + rng.uniform(1, pair.target.rows)) % pair.target.rows;
            rows.push_back(std::make_pair(pair.reference.ptr(point), pair.target.ptr(point)));
            others.push_back(std::make_pair(pair.reference.ptr(point), pair.target.ptr(other)));
        }
    rows.insert(rows.end(), others.begin(), others.end());

    Samples samples = {int(rows.size()), cv::Mat_<uchar>::zeros(pool.quads.rows, int(rows.size()))};
    for (const Candidate& bit : pool.candidates)
        for (int s = 0; s < samples.count; s++)
            samples.distances(bit.quad, s) += uchar(
                    (rows[s].first[bit.position / 8] ^ rows[s].second[bit.position / 8]) >> bit.position % 8 &
                    1);
    return samples;
}

//! A weak learner: "same" if at most `threshold` bits of the quad differ.
struct Weak
{
    int quad, threshold;
    double error;  // weighted, over all samples
};

Weak bestThreshold(const Samples& samples, const std::vector<double>& weights, int quad)
{
    double same[BITS_A_QUAD + 1] = {}, other[BITS_A_QUAD + 1] = {}, error = 0;
    for (int s = 0; s < samples.count; s++)
        (s < samples.count / 2 ? same : other)[samples.distances(quad, s)] += weights[s];
    for (double weight : same)
        error += weight;
    Weak best = {quad, -1, 2};
    // The largest threshold is skipped: it would classify all samples as "same".
    for (int threshold = 0; threshold < BITS_A_QUAD; threshold++)
    {
        error += other[threshold] - same[threshold];
        if (error < best.error)
            best = {quad, threshold, error};
    }
    return best;
}

void reweigh(const Samples& samples, const Weak& weak, std::vector<double>& weights)
{
    const double error = std::min(std::max(weak.error, 1e-9), 0.5);
    for (int s = 0; s < samples.count; s++)
    {
        const bool says = samples.distances(weak.quad, s) <= weak.threshold, is = s < samples.count / 2;
        weights[s] *= 0.5 / (says == is ? 1 - error : error);  // the sum stays 1
    }
}

}  // namespace

std::vector<int> selectByAdaBoost(const CandidatePool& pool, const std::vector<DescribedPair>& pairs,
        int bits, uint64 seed, const Progress& progress)
{
    const int quads = pool.quads.rows, wanted = bits / BITS_A_QUAD;
    if (wanted < 1 || wanted > quads || int(pool.candidates.size()) != quads * BITS_A_QUAD)
        CV_Error(cv::Error::StsOutOfRange,
                cv::format("%d bits are not those of 1 to %d quads of 4 bits", bits, quads));
    if (pairs.empty())
        CV_Error(cv::Error::StsBadArg, "no pair has enough points to train on");
    const Samples samples = drawSamples(pool, pairs, seed);
    std::vector<double> weights(samples.count, 1. / samples.count), benefit(quads);
    std::vector<bool> isChosen(quads);
    for (int round = 0; round <= wanted; round++)
    {
        Weak best = {0, 0, 2};
        for (int quad = 0; quad < quads; quad++)
            if (!isChosen[quad])
            {
                const Weak weak = bestThreshold(samples, weights, quad);
                benefit[quad] = 0.5 - weak.error;
                if (weak.error < best.error)
                    best = weak;
            }
        if (round == wanted || best.error >= 0.5)
            break;
        reweigh(samples, best, weights);
        isChosen[best.quad] = true;
        progress(round + 1, wanted);
    }

    std::vector<int> chosen;
    std::vector<double> ofBits;
    for (size_t i = 0; i < pool.candidates.size(); i++)
    {
        ofBits.push_back(benefit[pool.candidates[i].quad]);
        if (isChosen[pool.candidates[i].quad])
            chosen.push_back(int(i));
    }
    return fillBytes(pool, chosen, ofBits, bits);
}

}  // namespace iib_tools
