// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#include "hamming.hpp"

namespace cv { namespace iib {
CV_CPU_OPTIMIZATION_NAMESPACE_BEGIN
const HammingKernels& hammingKernels();
CV_CPU_OPTIMIZATION_NAMESPACE_END
}}  // namespace cv::iib

#ifndef CV_CPU_OPTIMIZATION_DECLARATIONS_ONLY

#include "opencv2/core/hal/hal.hpp"

namespace cv { namespace iib {
CV_CPU_OPTIMIZATION_NAMESPACE_BEGIN

namespace {

//! The pairs of a scan, compared one by one.
class PlainPairs
{
public:
    explicit PlainPairs(const CodePairs& p) : pairs(p), width(p.layout.words())
    {
        for (int i = 0; i < p.queries.rows; i++)
            p.layout.arrange(p.queries.ptr(i), append(queries));
        const size_t step = p.layout.blockWords();
        for (int i = 0; i < p.trainCount; i++)
            p.layout.fetch(p.trains + i / CodeLayout::CODES_PER_BLOCK * step, i % CodeLayout::CODES_PER_BLOCK,
                    append(trains));
    }

    bool isAllowed(int query, int train) const
    {
        return !pairs.allowed || pairs.allowed[(size_t)query * pairs.paddedTrains() + train];
    }

    //! Bits that differ in words `from` to `to`.
    int distance(int query, int train, int from, int to) const
    {
        const unsigned *a = &queries[(size_t)query * width], *b = &trains[(size_t)train * width];
        return hal::normHamming((const uchar*)(a + from), (const uchar*)(b + from), 4 * (to - from));
    }

private:
    unsigned* append(std::vector<unsigned>& codes)
    {
        codes.resize(codes.size() + width);
        return &codes[codes.size() - width];
    }

    const CodePairs& pairs;
    const int width;
    std::vector<unsigned> queries, trains;
};

void scanNearest(const NearestScan& scan)
{
    const PlainPairs pairs(scan.pairs);
    const int words = scan.pairs.layout.words();
    for (int query = 0; query < scan.pairs.queries.rows; query++)
        for (int train = 0; train < scan.pairs.trainCount; train++)
        {
            if (!pairs.isAllowed(query, train))
                continue;
            const int distance = pairs.distance(query, train, 0, words);
            MatchKey key = matchKey(distance, scan.firstTrain + train);
            for (int i = 0; i < scan.count; i++)
                if (key < scan.ofQueries[query * scan.count + i])
                    std::swap(key, scan.ofQueries[query * scan.count + i]);
            if (scan.ofTrains)
                scan.ofTrains[train] =
                        std::min(scan.ofTrains[train], matchKey(distance, scan.firstQuery + query));
        }
}

void scanPruned(const PrunedScan& scan)
{
    const PlainPairs pairs(scan.pairs);
    const PruningPolicy& policy = scan.policy;
    std::vector<int> distances(scan.pairs.trainCount);
    for (int query = 0; query < scan.pairs.queries.rows; query++)
    {
        std::vector<int> alive;
        for (int train = 0; train < scan.pairs.trainCount; train++)
            if (pairs.isAllowed(query, train))
                alive.push_back(train);
        std::fill(distances.begin(), distances.end(), 0);
        int words = 0;
        for (size_t i = 0; i < policy.stages.size(); i++)
        {
            const PruneStage& stage = policy.stages[i];
            int least = INT_MAX;
            std::vector<int> left;
            for (int train : alive)
            {
                const int more = pairs.distance(query, train, words, stage.words);
                distances[train] += more;
                least = std::min(least, distances[train]);
                if (more <= stage.most)
                    left.push_back(train);
            }
            if (scan.limits)
            {
                int& limit = scan.limits[query];
                if (policy.margin >= 0 && least < INT_MAX)
                    limit = std::min(limit, least + policy.margin);
                left.erase(std::remove_if(left.begin(), left.end(),
                                   [&](int train) { return distances[train] > limit; }),
                        left.end());
            }
            scan.passed[i] += (int64)left.size();
            alive.swap(left);
            words = stage.words;
        }
        for (int train : alive)
        {
            const int distance =
                    distances[train] + pairs.distance(query, train, words, scan.pairs.layout.words());
            if (distance < scan.queryThresholds[query] ||
                    (scan.trainThresholds && distance < scan.trainThresholds[train]))
                scan.found(query, train, distance);
        }
    }
}

}  // namespace

const HammingKernels& hammingKernels()
{
    static const HammingKernels kernels = {PACKING_TABLES, scanNearest, scanPruned, "plain"};
    return kernels;
}

CV_CPU_OPTIMIZATION_NAMESPACE_END
}}  // namespace cv::iib

#endif
