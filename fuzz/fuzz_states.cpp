// SPDX-License-Identifier: Apache-2.0

// Sequences of calls on matchers and their copies, each compared with a model that is searched pair by pair:
// what is added, copied, cleared, saved, loaded or set must be all that later answers depend on.

#include "file.hpp"
#include "matches.hpp"
#include "../modules/iib/src/matcher/search.hpp"

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
        case 11: setBlocks(s); break;
        case 12: useThreads(in.rarely(4) ? 3 : 1); break;
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
        // Codes of another width throw and leave everything as it was.
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

    //! One of the searches, among the codes that were added or in given ones.
    void ask(const Subject& s)
    {
        const Mat queries = takeDescriptors(width);
        MatcherOracle model = s.model;
        const bool given = in.rarely(4);
        if (given)
            model.images.assign(1, takeDescriptors(width));
        else if (in.flag())
            model.masks = takeMasks(model.images, queries);
        const int k = in.between(1, 4);
        switch (in.between(0, 3))
        {
        case 0: return askWithin(s, queries, model, given);
        case 1: return askForBest(s, queries, model, given);
        case 2: return askForArrays(s, queries, model, given, k);
        }
        Matches found(2);
        if (given)
            s.matcher->knnMatch(queries, model.images[0], found, k);
        else
            s.matcher->knnMatch(queries, found, k, model.masks);
        FUZZ_CHECK(equal(model.knn(queries, k), found));
    }

    std::vector<Mat> takeMasks(const std::vector<Mat>& images, const Mat& queries)
    {
        std::vector<Mat> masks;
        for (const Mat& image : images)
            masks.push_back(
                    in.flag() || queries.empty() || image.empty()
                            ? Mat()
                            : randomMask(in.take<uchar>(), queries.rows, image.rows, in.between(0, 4) / 4.));
        return masks;
    }

    void askWithin(const Subject& s, const Mat& queries, MatcherOracle& model, bool given)
    {
        const int radius = in.between(1, 8 * width);
        Matches found(1);
        model.adaptiveBlock = 0;  // radiusMatch is exact
        if (given)
            s.matcher->radiusMatch(queries, model.images[0], found, (float)radius);
        else
            s.matcher->radiusMatch(queries, found, (float)radius, model.masks);
        FUZZ_CHECK(equal(model.radius(queries, radius), found));
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
        FUZZ_CHECK(equal(expected, found));
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
        FUZZ_CHECK(equal(model.knn(queries, k), found));
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
