// SPDX-License-Identifier: Apache-2.0

// Sequences of calls on matchers and their copies, each compared with a model that is searched pair by pair:
// what is added, copied, cleared, saved, loaded or set must be all that later answers depend on.

#include "byte_source.hpp"
#include "file.hpp"
#include "../modules/iib/src/matcher/search.hpp"
#include "support/matcher_oracle.hpp"

#include <numeric>

namespace {

using namespace cv;
using namespace opencv_test;
using cv::iib::HierarchicalMatcher;

//! A matcher and what it should be.
struct Subject
{
    Ptr<HierarchicalMatcher> matcher;
    MatcherOracle model;
    bool ofAnyWidth = false;  //!< create() without level sizes, which takes the width of the first codes
    int codeBlocks = cv::iib::ScanBlocks().codeBlocksOfLimits;

    //! Whether the matcher knows the level sizes already.
    bool knowsLevels() const
    {
        return !ofAnyWidth ||
               std::any_of(model.images.begin(), model.images.end(), [](const Mat& m) { return m.rows > 0; });
    }

    //! As the matcher's mode is; the model knows ADAPTIVE's sample only within a last level of more than a word.
    void setMode(int mode)
    {
        if (mode == HierarchicalMatcher::ADAPTIVE && model.levelSizes.back() <= 4)
            mode = HierarchicalMatcher::EXACT;
        matcher->setMode(mode);
        model.thresholds =
                mode == HierarchicalMatcher::THRESHOLD ? matcher->getThresholds() : std::vector<float>();
        model.adaptiveBlock = mode == HierarchicalMatcher::ADAPTIVE ? 16 * codeBlocks : 0;
    }

    //! A new matcher of the same parameters and codes.
    void replace(const Ptr<HierarchicalMatcher>& other)
    {
        matcher = other;
        codeBlocks = cv::iib::ScanBlocks().codeBlocksOfLimits;
        setMode(matcher->getMode());
    }
};

class Session
{
public:
    explicit Session(ByteSource& source) : in(source)
    {
        Subject first;
        first.ofAnyWidth = in.rarely(4);
        for (int i = first.ofAnyWidth ? 1 : in.between(1, 3); i > 0; i--)
            first.model.levelSizes.push_back(in.between(1, in.rarely(8) ? 60 : 6));
        first.matcher = first.ofAnyWidth ? HierarchicalMatcher::create()
                                         : HierarchicalMatcher::create(first.model.levelSizes);
        width = std::accumulate(first.model.levelSizes.begin(), first.model.levelSizes.end(), 0);
        subjects.push_back(first);
    }

    void run()
    {
        for (int calls = 0; calls < 16 && in.left() > 0; calls++)
            step(subjects[in.between(0, (int)subjects.size() - 1)]);
        for (Subject& s : subjects)
            ask(s);
        setUseOptimized(true);
    }

private:
    void step(Subject& s)
    {
        switch (in.between(0, 21))
        {
        case 0:
        case 1:
        case 2: add(s); break;
        case 3: refuse(s); break;
        case 4: clear(s); break;
        case 5: copy(s, in.flag()); break;
        case 6: reload(s); break;
        case 7: reread(s); break;
        case 8: setUseOptimized(in.flag()); break;
        case 9: setParameters(s); break;
        case 10: overwrite(s); break;
        case 11: askWithTrainSet(s); break;
        case 12: askWithin(s); break;
        case 13: askForArrays(s); break;
        case 14: askForBest(s); break;
        case 15: inspect(s); break;
        case 16: setBlocks(s); break;
        case 17: useThreads(in.rarely(4) ? 3 : 1); break;
        case 18:
        case 19: askWithMasks(s); break;
        default: ask(s); break;
        }
    }

    Mat takeDescriptors(int bytes)
    {
        return randomDescriptors(in.take<uchar>(), in.between(0, in.rarely(32) ? 70 : 6), bytes);
    }

    void add(Subject& s)
    {
        const Mat codes = takeDescriptors(width);
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
    }

    //! Codes of another width throw and leave everything as it was.
    void refuse(Subject& s)
    {
        if (!s.knowsLevels())
            return;
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

    //! An index has the level sizes of its codes.
    void reload(Subject& s)
    {
        static const ScratchFile file;
        if (!s.knowsLevels())
            return;
        s.matcher->saveIndex(file.name);
        s.replace(HierarchicalMatcher::loadIndex(file.name));
        s.ofAnyWidth = false;
    }

    //! Parameters go through a file into a matcher of the same codes.
    void reread(Subject& s)
    {
        FileStorage out(".yml", FileStorage::WRITE | FileStorage::MEMORY);
        out << "m"
            << "{";
        s.matcher->write(out);
        out << "}";
        const FileStorage saved(out.releaseAndGetString(), FileStorage::READ | FileStorage::MEMORY);
        const Ptr<HierarchicalMatcher> other = HierarchicalMatcher::create(std::vector<int>(1, 3));
        other->read(saved["m"]);
        other->add(s.model.images);
        s.replace(other);
    }

    void setBlocks(Subject& s)
    {
        cv::iib::ScanBlocks& blocks = dynamic_cast<cv::iib::ScanBlocks&>(*s.matcher);
        blocks.queryCount = in.between(1, 9);
        blocks.codeBlocks = blocks.codeBlocksOfLimits = in.between(1, 3);
        s.codeBlocks = blocks.codeBlocksOfLimits;
        s.setMode(s.matcher->getMode());
    }

    void setParameters(Subject& s)
    {
        s.model.crossCheck = in.flag();
        s.matcher->setCrossCheck(s.model.crossCheck);
        s.model.maxRatio = in.between(1, 8) / 8.f;
        s.matcher->setMaxRatio(s.model.maxRatio);
        if (s.model.levelSizes.size() > 1)
            s.matcher->setThresholds(std::vector<float>(1, in.between(0, 32) / 32.f));
        s.setMode(in.between(HierarchicalMatcher::EXACT, HierarchicalMatcher::ADAPTIVE));
    }

    //! Values are copied when they are added; what becomes of the caller's matrices has no effect.
    void overwrite(const Subject& s)
    {
        for (Mat& m : added)
            if (!m.empty())
                m.setTo(in.take<uchar>());
        const Ptr<DescriptorMatcher> copy = s.matcher->clone(false);
        for (Mat m : copy->getTrainDescriptors())
            if (!m.empty())
                m.setTo(1);
    }

    void ask(Subject& s)
    {
        const Mat queries = takeDescriptors(width);
        const int k = in.between(1, 4);
        Matches found(2);
        s.matcher->knnMatch(queries, found, k);
        expect(s.model.knn(queries, k), found);
    }

    void askWithMasks(const Subject& s)
    {
        const Mat queries = takeDescriptors(width);
        MatcherOracle model = s.model;
        for (const Mat& image : model.images)
            model.masks.push_back(
                    in.flag() || queries.empty() || image.empty()
                            ? Mat()
                            : randomMask(in.take<uchar>(), queries.rows, image.rows, in.between(0, 4) / 4.));
        const int k = in.between(1, 4);
        Matches found(2);
        s.matcher->knnMatch(queries, found, k, model.masks);
        expect(model.knn(queries, k), found);
    }

    void askWithTrainSet(Subject& s)
    {
        const Mat queries = takeDescriptors(width);
        MatcherOracle model = s.model;
        model.images.assign(1, takeDescriptors(width));
        Matches found(1);
        switch (in.between(0, 2))
        {
        case 0: {
            const int radius = in.between(1, 8 * width);
            model.adaptiveBlock = 0;  // radiusMatch is exact
            s.matcher->radiusMatch(queries, model.images[0], found, (float)radius);
            return expect(model.radius(queries, radius), found);
        }
        case 1: {
            std::vector<DMatch> best(1);
            s.matcher->match(queries, model.images[0], best);
            return expectBest(model.knn(queries, 1), best);
        }
        default: s.matcher->knnMatch(queries, model.images[0], found, 2);
        }
        expect(model.knn(queries, 2), found);
    }

    void askForBest(Subject& s)
    {
        const Mat queries = takeDescriptors(width);
        std::vector<DMatch> best(1);
        s.matcher->match(queries, best);
        expectBest(s.model.knn(queries, 1), best);
    }

    static void expectBest(const Matches& expected, const std::vector<DMatch>& best)
    {
        Matches found(expected.size());
        for (const DMatch& m : best)
            found[m.queryIdx].push_back(m);
        expect(expected, found);
    }

    //! What is set is what is reported.
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
        s.matcher->resetCost();
        FUZZ_CHECK(s.matcher->matchCost() == 0);
    }

    void askWithin(Subject& s)
    {
        const Mat queries = takeDescriptors(width);
        const int radius = in.between(1, 8 * width);
        Matches found(1);
        MatcherOracle model = s.model;
        model.adaptiveBlock = 0;  // radiusMatch is exact
        s.matcher->radiusMatch(queries, found, (float)radius);
        expect(model.radius(queries, radius), found);
    }

    void askForArrays(const Subject& s)
    {
        const Mat queries = takeDescriptors(width);
        const int k = in.between(1, 4);
        MatcherOracle model = s.model;
        const bool ownTrains = in.flag();
        Mat_<int> indices, distances, images;
        if (ownTrains)
        {
            model.images.assign(1, takeDescriptors(width));
            s.matcher->knnMatchArrays(queries, model.images[0], indices, distances, k);
        }
        else
            s.matcher->knnMatchArrays(queries, indices, distances, k, noArray(), images);
        Matches found(queries.rows);
        for (int q = 0; q < indices.rows; q++)
            for (int i = 0; i < k && indices(q, i) >= 0; i++)
                found[q].push_back(
                        DMatch(q, indices(q, i), ownTrains ? 0 : images(q, i), (float)distances(q, i)));
        expect(model.knn(queries, k), found);
    }

    static void expect(const Matches& expected, const Matches& found)
    {
        FUZZ_CHECK(expected.size() == found.size());
        for (size_t q = 0; q < found.size(); q++)
        {
            FUZZ_CHECK(expected[q].size() == found[q].size());
            for (size_t i = 0; i < found[q].size(); i++)
                FUZZ_CHECK(expected[q][i].distance == found[q][i].distance &&
                           expected[q][i].imgIdx == found[q][i].imgIdx &&
                           expected[q][i].trainIdx == found[q][i].trainIdx);
        }
    }

    ByteSource& in;
    int width;
    std::vector<Subject> subjects;
    std::vector<Mat> added;  //!< the matrices as their owner sees them
};

void run(ByteSource& in) { Session(in).run(); }

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const uchar* data, size_t size)
{
    useThreads(1);
    return runTarget(run, data, size);
}
