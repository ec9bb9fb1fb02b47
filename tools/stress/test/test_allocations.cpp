// SPDX-License-Identifier: Apache-2.0

// Every allocation of the library, and of OpenCV beneath it, fails in turn. The call throws, and the object stays as it was.

#include "opencv2/core/utils/filesystem.hpp"
#include "opencv2/iib.hpp"
#include "opencv2/iib_index.hpp"
#include "opencv2/ts.hpp"

#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <new>

namespace {

// One thread allocates, so that plain numbers do.
bool armed = false, failOn = false;  // failOn: all later ones fail as well
long untilFailure = 0, failed = 0;

bool failNow()
{
    if (!armed || (failed > 0 && !failOn) || untilFailure-- > 0)
        return false;
    failed++;
    return true;
}

}  // namespace

// The dynamic linker prefers these to those of the libraries.
void* operator new(std::size_t size)
{
    void* memory = failNow() ? 0 : std::malloc(size + (size == 0));
    if (!memory)
        throw std::bad_alloc();
    return memory;
}
void operator delete(void* memory) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }  // called from C++14 on

//! cv::fastMalloc's.
extern "C" int posix_memalign(void** memory, std::size_t alignment, std::size_t size) noexcept
{
    *memory = failNow() ? 0 : aligned_alloc(alignment, (size + alignment - 1) / alignment * alignment);
    return *memory ? 0 : ENOMEM;
}

namespace {

using namespace cv;
using cv::iib::HierarchicalMatcher;
using cv::iib::IIB;
using cv::iib::MappedIndex;

bool equal(const Mat& a, const Mat& b)
{
    return a.size() == b.size() && (a.empty() || cv::norm(a, b, NORM_INF) == 0);
}

Mat noise(Size size, int type, int seed)
{
    Mat image(size, type);
    RNG(seed).fill(image, RNG::UNIFORM, 0, CV_MAT_DEPTH(type) == CV_8U ? 256 : 65536);
    return image;
}

/** Calls `step` with its first allocation failing, then its second and so on, until none fails; after each call `check` expects the
 state before. Once with one failure, and once with all later allocations failing too. */
void failEachAllocation(
        const std::string& what, const std::function<void()>& step, const std::function<void()>& check)
{
    step();  // what is made once for all
    int failures = 0;
    for (const bool on : {false, true})
        for (long n = 0;; n++)
        {
            bool thrown = false;
            failOn = on;
            untilFailure = n;
            failed = 0;
            try
            {
                armed = true;
                step();
            }
            catch (const std::bad_alloc&)
            {
                thrown = true;
            }
            catch (const cv::Exception& e)
            {
                thrown = e.code == Error::StsNoMem;
            }
            armed = false;
            check();
            ASSERT_FALSE(testing::Test::HasFailure()) << what << ", allocation " << n;
            if (failed == 0)
                break;
            ASSERT_TRUE(thrown) << what << ": no exception of lacking memory, allocation " << n;
            failures++;
        }
    std::printf("%s: %d failures\n", what.c_str(), failures);
    EXPECT_GT(failures, 0) << what << ": nothing was allocated";
}

void describe(const std::string& what, const Ptr<IIB>& iib, int type)
{
    const Mat image = noise(Size(200, 150), type, 1);
    const std::vector<Mat> extra(iib->getExtraChannels(), Mat(image.size(), CV_16U, Scalar(7)));
    std::vector<KeyPoint> given;
    for (int i = 0; i < 12; i++)
        given.push_back(KeyPoint(15.f * i, 11.f * i, 5.f + 2 * i, i % 3 ? 29.f * i : -1.f));
    Mat expected;
    std::vector<KeyPoint> keypoints = given;
    iib->compute(image, extra, keypoints, expected);

    const auto compute = [&] {
        std::vector<KeyPoint> k = given;
        Mat descriptors;
        iib->compute(image, extra, k, descriptors);
        EXPECT_TRUE(equal(expected, descriptors)) << "other descriptors";
    };
    failEachAllocation(what, compute, compute);
}

void changeExtractor()
{
    const Ptr<IIB> iib = IIB::createPreset(IIB::PRESET_TINY);
    const Mat first = iib->getSelection(), second = first.rowRange(0, first.rows / 2).clone();
    const auto check = [&] {
        const Mat now = iib->getSelection();
        EXPECT_TRUE(equal(now, first) || equal(now, second)) << "a third selection";
        iib->setSelection(first);
    };
    failEachAllocation(
            "setSelection", [&] { iib->setSelection(second); }, check);
}

typedef std::vector<std::vector<DMatch>> Matches;

void match(const std::string& what, const HierarchicalMatcher& matcher,
        const std::function<void(Matches&)>& call)
{
    const auto found = [&] {
        Matches matches;
        call(matches);
        std::vector<float> fields;
        for (const std::vector<DMatch>& row : matches)
            for (const DMatch& m : row)
                for (float field : {(float)m.queryIdx, (float)m.imgIdx, (float)m.trainIdx, m.distance})
                    fields.push_back(field);
        return fields;
    };
    const std::vector<float> expected = found();
    const auto again = [&] { EXPECT_TRUE(found() == expected) << "other matches"; };
    failEachAllocation(what, again, again);
    EXPECT_EQ(1u, matcher.getTrainDescriptors().size()) << what;
}

void matchAll()
{
    const Mat train = noise(Size(42, 300), CV_8U, 2), queries = noise(Size(42, 70), CV_8U, 3);
    const Ptr<HierarchicalMatcher> matcher =
            HierarchicalMatcher::create({2, 8, 32}, HierarchicalMatcher::EXACT, 0.35f, true);
    matcher->add(train);
    match("knnMatch", *matcher, [&](Matches& m) { matcher->knnMatch(queries, m, 3); });
    match("radiusMatch", *matcher, [&](Matches& m) { matcher->radiusMatch(queries, m, 150); });
    match("knnMatch of two sets", *matcher, [&](Matches& m) { matcher->knnMatch(queries, train, m, 2); });
    match("knnMatch of a clone", *matcher, [&](Matches& m) { matcher->clone()->knnMatch(queries, m, 2); });
    const String file = tempfile(".iib");
    match("saveIndex and loadIndex", *matcher, [&](Matches& m) {
        matcher->saveIndex(file);
        HierarchicalMatcher::loadIndex(file)->knnMatch(queries, m, 2);
    });
    std::remove(file.c_str());
}

void addToMatcher(int width)
{
    const Mat train = noise(Size(width, 1200), CV_8U, 4);
    const Ptr<HierarchicalMatcher> matcher = HierarchicalMatcher::create({2, width - 2});
    const auto check = [&] {
        std::vector<DMatch> matches;
        const size_t images = matcher->getTrainDescriptors().size();
        matcher->match(train.row(1100), matches, std::vector<Mat>(images));
        ASSERT_EQ(std::min(images, (size_t)1), matches.size()) << "the index does not fit the descriptors";
        EXPECT_TRUE(images == 0 ||
                    (matches[0].trainIdx == 1100 && matches[0].imgIdx == 0 && matches[0].distance == 0));
        if (images > 3)
            matcher->clear();
    };
    failEachAllocation(
            "add", [&] { matcher->add(train); }, check);
}

void changeMatcher()
{
    const Ptr<HierarchicalMatcher> matcher = HierarchicalMatcher::create({2, 8});
    FileStorage fs("%YAML:1.0\n---\nlevelSizes: [ 4, 8, 16 ]\nmode: 1\nthresholds: [ 0.5, 0.25 ]\n",
            FileStorage::READ | FileStorage::MEMORY);
    const auto check = [&] {
        const bool changed = matcher->levelSizes().size() == 3;
        const int mode = changed ? HierarchicalMatcher::THRESHOLD : HierarchicalMatcher::EXACT;
        EXPECT_TRUE(matcher->getThresholds().size() == (changed ? 2u : 1u) && matcher->getMode() == mode)
                << "half of the parameters";
        const Mat code(1, changed ? 28 : 10, CV_8U, Scalar(0));
        std::vector<DMatch> matches;
        matcher->match(code, code, matches);
        EXPECT_EQ(1u, matches.size());
    };
    failEachAllocation(
            "read", [&] { matcher->read(fs.root()); }, check);
}

void commitToIndex()
{
    const String folder = tempfile("");
    const Ptr<MappedIndex> index = MappedIndex::create(folder, {2, 8});
    const std::vector<Mat> images(3, noise(Size(10, 4), CV_8U, 5));
    std::vector<int64> hidden(1, 0);
    uint64 before = 0;
    bool done = false;
    const auto check = [&] {
        const uint64 after = MappedIndex::open(folder)->version();
        EXPECT_EQ(after, index->version()) << "not what is in the folder";
        EXPECT_EQ(done, after != before) << "a call that threw has committed, or the other way round";
    };
    const auto committing = [&](const std::function<void()>& call) {
        return [&, call] {
            before = index->version();
            done = false;
            call();
            done = true;
        };
    };
    failEachAllocation("MappedIndex::add", committing([&] { index->add(images); }), check);
    failEachAllocation("MappedIndex::remove", committing([&] {
        index->remove(hidden);
        hidden[0]++;
    }),
            check);
    utils::fs::remove_all(folder);
}

TEST(Stress, allocations)
{
    const int threads = getNumThreads();
    setNumThreads(1);  // a thread pool's own allocations are not this library's
    describe("compute", IIB::create(), CV_8UC1);
    describe("compute, colour", IIB::create(), CV_8UC3);
    describe("compute, 32F", IIB::create(), CV_32FC1);
    describe("compute, rotated", IIB::create(2.f, 5, 63, IIB::MAPPING_SORT, true, true), CV_16UC1);
    describe("compute, extra channels", IIB::create(2.f, 4, 15, IIB::MAPPING_HAAR, false, false, 3), CV_8UC1);
    describe("compute, selection", IIB::createPreset(IIB::PRESET_TINY), CV_8UC1);
    changeExtractor();
    matchAll();
    addToMatcher(10);
    addToMatcher(600);
    changeMatcher();
    commitToIndex();
    setNumThreads(threads);
}

}  // namespace
