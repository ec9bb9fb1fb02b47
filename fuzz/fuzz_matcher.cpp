// SPDX-License-Identifier: Apache-2.0

// HierarchicalMatcher with any level sizes, mode, thresholds, images, masks, k and radius. Expects a cv::Exception as
// in the header, otherwise the matches of a model that compares all pairs. Calls come in sequences on matchers and
// their copies: later results must depend only on what was added, copied, cleared, saved, loaded or set.

#include "byte_source.hpp"
#include "support/matcher_oracle.hpp"
#include "support/temporary_file.hpp"

#include <numeric>

namespace {

using namespace cv;
using namespace opencv_test;
using namespace cv::iib;

//! Whether two results have the same matches in the same order.
bool equal(const Matches& a, const Matches& b)
{
    const auto sameMatch = [](const DMatch& x, const DMatch& y) {
        return x.distance == y.distance && x.queryIdx == y.queryIdx && x.imgIdx == y.imgIdx &&
               x.trainIdx == y.trainIdx;
    };
    const auto sameRow = [&](const std::vector<DMatch>& x, const std::vector<DMatch>& y) {
        return x.size() == y.size() && std::equal(x.begin(), x.end(), y.begin(), sameMatch);
    };
    return a.size() == b.size() && std::equal(a.begin(), a.end(), b.begin(), sameRow);
}

//! A matcher and its model.
struct Subject
{
    Ptr<HierarchicalMatcher> matcher;
    MatcherOracle model;
    bool ofAnyWidth = false;  //!< made without level sizes, so that the first codes decide the width
    ScanChunk chunk;          //!< chunk of a separate search
    bool isKnown = true;      //!< whether the model supports the matcher's mode

    //! Whether the matcher knows the level sizes already.
    bool knowsLevels() const
    {
        return !ofAnyWidth ||
               std::any_of(model.images.begin(), model.images.end(), [](const Mat& m) { return m.rows > 0; });
    }

    //! Sets the mode of both; the model supports ADAPTIVE's sample only with a last level of more than a word.
    void setMode(int mode)
    {
        matcher->setMode(mode);
        isKnown = mode != HierarchicalMatcher::ADAPTIVE || model.levelSizes.back() > 4;
        model.thresholds =
                mode == HierarchicalMatcher::THRESHOLD ? matcher->getThresholds() : std::vector<float>();
        model.adaptiveBlock =
                mode == HierarchicalMatcher::ADAPTIVE ? 16 * PruningPolicy::CODE_BLOCKS_OF_LIMITS : 0;
    }

    //! Replaces the matcher by another one with the same parameters and codes.
    void replace(const Ptr<HierarchicalMatcher>& other)
    {
        matcher = other;
        setMode(matcher->getMode());
    }
};

class Session
{
public:
    explicit Session(ByteSource& source) : in(source) {}

    void run()
    {
        const bool wild = in.rarely(8);  // parameters that may be refused
        if (refused([&] { subjects.assign(1, drawFirst(wild)); }))
        {
            FUZZ_CHECK(wild);
            return;
        }
        for (int calls = 0; calls < 16 && in.left() > 0; calls++)
            step(subjects[in.between(0, (int)subjects.size() - 1)]);
        for (Subject& s : subjects)
            ask(s);
        setUseOptimized(true);
    }

private:
    Subject drawFirst(bool wild)
    {
        Subject s;
        s.ofAnyWidth = !wild && in.rarely(4);
        for (int i = s.ofAnyWidth ? 1 : in.between(1, 4); i > 0; i--)
            s.model.levelSizes.push_back(in.between(1 - 2 * wild, in.rarely(8) ? 70 : 9));
        width = std::accumulate(s.model.levelSizes.begin(), s.model.levelSizes.end(), 0);
        s.model.crossCheck = in.flag() && !s.ofAnyWidth;
        s.matcher = s.ofAnyWidth ? HierarchicalMatcher::create()
                                 : HierarchicalMatcher::create(s.model.levelSizes,
                                           in.between(-wild, 2 + wild), drawShare(wild), s.model.crossCheck);
        s.setMode(s.matcher->getMode());
        if (in.flag())
            setChunk(s);
        return s;
    }

    //! A number from 0 to 1, or any number.
    float drawShare(bool wild) { return wild ? in.number() : in.between(0, 64) / 64.f; }

    void step(Subject& s)
    {
        switch (in.between(0, 16))
        {
        case 0:
        case 1:
        case 2: add(s); break;
        case 3: clear(s); break;
        case 4: copy(s, in.flag()); break;
        case 5: reload(s); break;
        case 6: reread(s); break;
        case 7: setUseOptimized(in.flag()); break;
        case 8: setParameters(s); break;
        case 9: overwrite(s); break;
        case 10: inspect(s); break;
        case 11: setChunk(s); break;
        case 12: useThreads(in.rarely(4) ? 3 : 1); break;
        default: ask(s); break;
        }
    }

    Mat drawDescriptors(int bytes)
    {
        Mat codes = randomDescriptors(in.read<uchar>(), in.between(0, in.rarely(32) ? 70 : 7), bytes);
        for (int i = in.between(0, 4); i > 0 && !codes.empty(); i--)
            codes.at<uchar>(in.between(0, codes.rows - 1), in.between(0, bytes - 1)) = in.read<uchar>();
        return codes;
    }

    void add(Subject& s)
    {
        const Mat codes = drawDescriptors(width);
        switch (in.between(0, 2))
        {
        case 0: s.matcher->add(codes); break;
        case 1: s.matcher->add(std::vector<Mat>(1, codes)); break;
        default: {
            UMat mapped;
            codes.copyTo(mapped);
            s.matcher->add(mapped);
        }
        }
        s.model.images.push_back(codes.clone());
        added.push_back(codes);
        // Codes of another width must throw and change nothing.
        if (in.rarely(4) && s.knowsLevels())
            FUZZ_CHECK(refused([&] { s.matcher->add(Mat(2, width + 1, CV_8U, Scalar(1))); }));
    }

    void clear(Subject& s)
    {
        s.matcher->clear();
        s.model.images.clear();
    }

    void copy(const Subject& s, bool emptyTrainData)
    {
        if (subjects.size() >= 4)
            return;
        Subject other = s;
        other.matcher = s.matcher->clone(emptyTrainData).dynamicCast<HierarchicalMatcher>();
        if (emptyTrainData)
            other.model.images.clear();
        subjects.push_back(other);
    }

    //! A loaded index must have the level sizes of its codes.
    void reload(Subject& s)
    {
        static const TemporaryFile file;
        if (!s.knowsLevels())
            return;
        s.matcher->saveIndex(file.name);
        s.replace(HierarchicalMatcher::loadIndex(file.name));
        s.ofAnyWidth = false;
    }

    //! Writes parameters to a file and reads them into a matcher with the same codes.
    void reread(Subject& s)
    {
        const FileStorage saved(written(*s.matcher), FileStorage::READ | FileStorage::MEMORY);
        const Ptr<HierarchicalMatcher> other = HierarchicalMatcher::create(std::vector<int>(1, 3));
        other->read(saved["object"]);
        other->add(s.model.images);
        s.replace(other);
    }

    void setChunk(Subject& s)
    {
        s.chunk.queryCount = in.between(1, 9);
        s.chunk.codeBlocks = s.chunk.codeBlocksOfLimits = in.between(1, 3);
    }

    void setParameters(Subject& s)
    {
        s.model.crossCheck = in.flag();
        s.matcher->setCrossCheck(s.model.crossCheck);
        // A refused call must change nothing.
        const bool wild = in.rarely(8);
        const float maxRatio = wild ? in.number() : in.between(1, 16) / 16.f;
        const bool valid = maxRatio > 0 && maxRatio <= 1;
        FUZZ_CHECK(refused([&] { s.matcher->setMaxRatio(maxRatio); }) == !valid);
        s.model.maxRatio = valid ? maxRatio : s.model.maxRatio;
        std::vector<float> thresholds(in.flag() ? 1 : s.model.levelSizes.size() - !wild);
        for (float& threshold : thresholds)
            threshold = drawShare(wild);
        if (!thresholds.empty())
            FUZZ_CHECK(!refused([&] { s.matcher->setThresholds(thresholds); }) || wild || s.ofAnyWidth);
        const int mode = in.between(HierarchicalMatcher::EXACT - wild, HierarchicalMatcher::ADAPTIVE + wild);
        s.setMode(refused([&] { s.matcher->setMode(mode); }) ? s.matcher->getMode() : mode);
    }

    //! Codes are copied when added: later changes of the caller's matrices must have no effect.
    void overwrite(const Subject& s)
    {
        for (Mat& m : added)
            if (!m.empty())
                m.setTo(in.read<uchar>());
        const Ptr<DescriptorMatcher> copy = s.matcher->clone(false);
        for (Mat m : copy->getTrainDescriptors())
            if (!m.empty())
                m.setTo(1);
    }

    //! Arguments that do not fit the codes must be refused.
    void askWrongly(const Subject& s)
    {
        std::vector<Mat> masks(s.model.images.size());
        size_t image = 0;
        while (image < masks.size() && s.model.images[image].empty())
            image++;
        if (image == masks.size())
            return;
        const int wrong = in.between(0, 3), rows = s.model.images[image].rows;
        const Mat queries(3, width + (wrong == 0), CV_8U, Scalar(1));
        if (wrong == 1)
            masks.push_back(Mat());
        else if (wrong > 1)
            masks[image] = Mat(3 + (wrong == 2), rows, wrong == 2 ? CV_8U : CV_32S, Scalar(1));
        Matches found;
        FUZZ_CHECK(refused([&] { s.matcher->knnMatch(queries, found, 2, masks); }));
    }

    //! Runs one of the searches, in the added codes or in given ones.
    void ask(const Subject& s)
    {
        if (in.rarely(16))
            askWrongly(s);
        const Mat queries = drawDescriptors(width);
        MatcherOracle model = s.model;
        const bool given = in.rarely(4);
        if (given)
            model.images.assign(1, drawDescriptors(width));
        else if (in.flag())
            model.masks = drawMasks(model.images, queries);
        const int k = in.rarely(16) ? INT_MAX : in.between(1, 20);
        switch (in.between(0, 3))
        {
        case 0: return askWithin(s, queries, model, given);
        case 1: return askForBest(s, queries, model, given);
        case 2: return askForArrays(s, queries, model, given, std::min(k, 20));
        }
        Matches found(2), expected = model.knn(queries, k);
        const bool compact = in.flag();
        if (given)
            s.matcher->knnMatch(queries, model.images[0], found, k, noArray(), compact);
        else
            s.matcher->knnMatch(queries, found, k, model.masks, compact);
        if (compact)
            expected.erase(std::remove_if(expected.begin(), expected.end(),
                                   [](const std::vector<DMatch>& row) { return row.empty(); }),
                    expected.end());
        if (!hasBothSets(queries, model))
            expected.assign(2, std::vector<DMatch>());  // the previous content
        FUZZ_CHECK(!s.isKnown || equal(expected, found));
        SearchCost cost;
        model.adaptiveBlock = model.adaptiveBlock > 0 ? 16 * s.chunk.codeBlocksOfLimits : 0;
        found = searched(model, queries, k, 0, s.chunk, cost);
        FUZZ_CHECK(!s.isKnown || equal(model.knn(queries, k), found));
    }

    std::vector<Mat> drawMasks(const std::vector<Mat>& images, const Mat& queries)
    {
        std::vector<Mat> masks;
        for (const Mat& image : images)
            masks.push_back(
                    in.flag() || queries.empty() || image.empty()
                            ? Mat()
                            : randomMask(in.read<uchar>(), queries.rows, image.rows, in.between(0, 4) / 4.));
        return masks;
    }

    //! DescriptorMatcher returns at once unless both sets have descriptors.
    static bool hasBothSets(const Mat& queries, const MatcherOracle& model)
    {
        return !queries.empty() && !model.images.empty();
    }

    void askWithin(const Subject& s, const Mat& queries, MatcherOracle& model, bool given)
    {
        const float radius = in.rarely(4) ? in.number() : (float)in.between(1, 8 * width);
        Matches found(1);
        model.adaptiveBlock = 0;  // radiusMatch is exact
        const bool thrown = refused([&] {
            if (given)
                s.matcher->radiusMatch(queries, model.images[0], found, radius);
            else
                s.matcher->radiusMatch(queries, found, radius, model.masks);
        });
        if (!hasBothSets(queries, model))
        {
            FUZZ_CHECK(!thrown && found.empty());
            return;
        }
        FUZZ_CHECK(!thrown || !(radius > FLT_EPSILON));  // also true for NaN
        if (!(radius > FLT_EPSILON))
            return;
        const int whole = cvFloor(std::min((double)radius, 8. * width));
        SearchCost cost;
        FUZZ_CHECK(equal(model.radius(queries, whole), found));
        FUZZ_CHECK(equal(found, searched(model, queries, 0, whole, s.chunk, cost)));
    }

    void askForBest(const Subject& s, const Mat& queries, MatcherOracle& model, bool given)
    {
        std::vector<DMatch> best(1);
        if (given)
            s.matcher->match(queries, model.images[0], best);
        else
            s.matcher->match(queries, best, model.masks);
        const Matches expected = model.knn(queries, 1);
        Matches found(expected.size());
        for (const DMatch& m : best)
            found[m.queryIdx].push_back(m);
        FUZZ_CHECK(!s.isKnown || equal(expected, found));
    }

    void askForArrays(const Subject& s, const Mat& queries, MatcherOracle& model, bool given, int k)
    {
        Mat_<int> indices, distances, images;
        model.masks.clear();
        if (given)
            s.matcher->knnMatchArrays(queries, model.images[0], indices, distances, k);
        else
            s.matcher->knnMatchArrays(queries, indices, distances, k, noArray(), images);
        Matches found(queries.rows);
        for (int q = 0; q < indices.rows; q++)
            for (int i = 0; i < k && indices(q, i) >= 0; i++)
                found[q].push_back(
                        DMatch(q, indices(q, i), given ? 0 : images(q, i), (float)distances(q, i)));
        FUZZ_CHECK(!s.isKnown || equal(model.knn(queries, k), found));
    }

    //! Getters must return what was set.
    void inspect(const Subject& s)
    {
        const std::vector<Mat> images = s.matcher->getTrainDescriptors();
        FUZZ_CHECK(s.matcher->levelSizes() == (s.knowsLevels() ? s.model.levelSizes : std::vector<int>()));
        FUZZ_CHECK(images.size() == s.model.images.size());
        for (size_t i = 0; i < images.size(); i++)
            FUZZ_CHECK(images[i].rows == s.model.images[i].rows &&
                       (images[i].empty() || cv::norm(images[i], s.model.images[i], NORM_INF) == 0));
        FUZZ_CHECK(s.matcher->getCrossCheck() == s.model.crossCheck &&
                   s.matcher->getMaxRatio() == s.model.maxRatio && s.matcher->isMaskSupported());
        FUZZ_CHECK(s.matcher->empty() == s.model.images.empty());
        const double cost = s.matcher->matchCost();
        FUZZ_CHECK(cost >= 0 && cost <= 1);
        s.matcher->resetCost();
        FUZZ_CHECK(s.matcher->matchCost() == 0);
    }

    ByteSource& in;
    int width = 0;
    std::vector<Subject> subjects;
    std::vector<Mat> added;  //!< the caller's matrices
};

}  // namespace

FUZZ_TARGET { Session(in).run(); }
