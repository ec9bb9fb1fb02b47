// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#include "../support/matcher_oracle.hpp"
#include "../support/temporary_file.hpp"
#include "../support/test_errors.hpp"

namespace opencv_test { namespace {

// As the first version wrote them.
const String GOOD = "%YAML:1.0\n---\nlevelSizes: [ 8, 24 ]\nmode: 2\nthresholds: [ 3.0000001192092896e-01 ]\n"
                    "crossCheck: 1\nmaxRatio: 7.5000000000000000e-01\n";

Ptr<HierarchicalMatcher> readText(const String& text)
{
    const Ptr<HierarchicalMatcher> matcher = HierarchicalMatcher::create({4});
    matcher->read(FileStorage(text, FileStorage::READ | FileStorage::MEMORY).root());
    return matcher;
}

TEST(IIB_MatcherParameters, first_parameters_stay_readable)
{
    const Ptr<HierarchicalMatcher> matcher = readText(GOOD);
    EXPECT_EQ((std::vector<int>{8, 24}), matcher->levelSizes());
    EXPECT_EQ(HierarchicalMatcher::ADAPTIVE, matcher->getMode());
    EXPECT_EQ(std::vector<float>(1, 0.3f), matcher->getThresholds());
    EXPECT_TRUE(matcher->getCrossCheck());
    EXPECT_EQ(0.75f, matcher->getMaxRatio());
}

TEST(IIB_MatcherParameters, damaged_values_throw_and_are_named)
{
    const char* const cases[][3] = {// from, to, what the error names
            {"crossCheck: 1", "crossCheck: \"false\"", "crossCheck"},
            {"crossCheck: 1", "crossCheck: 2", "crossCheck"},
            {"crossCheck: 1", "crossCheck: 0.5", "crossCheck"}, {"[ 8, 24 ]", "{ a: 1 }", "levelSizes"},
            {"[ 8, 24 ]", "[ 8.4, 24 ]", "levelSizes"}, {"[ 8, 24 ]", "[ 8, many ]", "levelSizes"},
            {"[ 8, 24 ]", "wide", "levelSizes"}, {"[ 8, 24 ]", "[ 8, -24 ]", "levelSizes"},
            {"mode: 2", "mode: 1.5", "mode"}, {"mode: 2", "mode: EXACT", "mode"},
            {"mode: 2", "mode: 3", "mode"}, {"thresholds: [ 3", "thresholds: [ 7, 3", "thresholds"},
            {"[ 3.0", "[ .Nan, 3.0", "threshold"}, {"[ 3.0000001192092896e-01", "[ 7.0", "threshold"},
            {"[ 3.0000001192092896e-01 ]", "high", "thresholds"},
            {"maxRatio: 7.5", "maxRatio: half # 7.5", "maxRatio"},
            {"maxRatio: 7.5", "maxRatio: [ 1 ] # 7.5", "maxRatio"}, {"mode: 2", "mode: 4294967297.", "mode"},
            {"[ 8, 24 ]", "[ 8, 4294967304. ]", "levelSizes"},
            {"maxRatio: 7.5", "maxRatio: 1e39 # 7.5", "maxRatio"}};
    for (const auto& c : cases)
    {
        SCOPED_TRACE(c[1]);
        const Ptr<HierarchicalMatcher> matcher = HierarchicalMatcher::create({4});
        try
        {
            matcher->read(
                    FileStorage(replaced(GOOD, c[0], c[1]), FileStorage::READ | FileStorage::MEMORY).root());
            ADD_FAILURE() << "no exception";
        }
        catch (const cv::Exception& e)
        {
            EXPECT_NE(String::npos, e.err.find(c[2])) << e.err;
        }
        EXPECT_EQ(std::vector<int>(1, 4), matcher->levelSizes());
    }
}

// If this OpenCV reads them as 64-bit numbers.
TEST(IIB_MatcherParameters, whole_numbers_beyond_32_bits)
{
    const FileStorage probe("%YAML:1.0\n---\nnumber: 4294967304\n", FileStorage::READ | FileStorage::MEMORY);
    if ((double)probe["number"] != 4294967304.)
        return;
    expectError(
            Error::StsParseError, "levelSizes", [] { readText(replaced(GOOD, "[ 8,", "[ 4294967304,")); });
    expectError(
            Error::StsParseError, "mode", [] { readText(replaced(GOOD, "mode: 2", "mode: 4294967297")); });
}

TEST(IIB_MatcherParameters, files_of_others_are_refused)
{
    const TemporaryFile file(".yml");
    BFMatcher(NORM_HAMMING).save(file.name);
    const Ptr<HierarchicalMatcher> matcher = HierarchicalMatcher::create({4});
    DescriptorMatcher& base = *matcher;
    EXPECT_THROW(base.read(file.name), cv::Exception);
    expectError(Error::StsParseError, "octaves",
            [&] { readText("%YAML:1.0\n---\nthreshold: 30\noctaves: 3\n"); });
    IIB::create()->save(file.name);
    EXPECT_THROW(base.read(file.name), cv::Exception);
    EXPECT_THROW(base.read(String(file.name + ".missing.yml")), cv::Exception);
    expectError(Error::StsParseError, "nothing", [&] { matcher->read(FileNode()); });
}

TEST(IIB_MatcherParameters, thresholds_of_one_level_are_checked)
{
    const Ptr<HierarchicalMatcher> matcher = HierarchicalMatcher::create({4});
    EXPECT_THROW(matcher->setThresholds({7.f}), cv::Exception);
    EXPECT_THROW(matcher->setThresholds({NOT_A_NUMBER}), cv::Exception);
    EXPECT_NO_THROW(matcher->setThresholds({0.5f}));
    EXPECT_TRUE(matcher->getThresholds().empty());
}

// HierarchicalMatcher::create() without level sizes, in place of BFMatcher().

TEST(IIB_MatcherCreate, takes_the_width_of_the_first_codes)
{
    const Ptr<HierarchicalMatcher> matcher = HierarchicalMatcher::create();
    EXPECT_EQ(HierarchicalMatcher::EXACT, matcher->getMode());
    EXPECT_TRUE(matcher->levelSizes().empty());
    EXPECT_TRUE(matcher->empty());
    matcher->add(std::vector<Mat>{Mat(), randomDescriptors(1, 9, 32)});
    EXPECT_EQ(std::vector<int>(1, 32), matcher->levelSizes());
    Matches actual;
    matcher->knnMatch(randomDescriptors(2, 7, 32), actual, 2);
    ASSERT_EQ(7u, actual.size());
    for (const std::vector<DMatch>& row : actual)
        EXPECT_EQ(1, row[0].imgIdx);
    expectError(Error::StsUnmatchedSizes, "clear()", [&] { matcher->add(randomDescriptors(3, 4, 64)); });
    EXPECT_THROW(matcher->knnMatch(randomDescriptors(3, 4, 64), actual, 1), cv::Exception);
    EXPECT_EQ(2u, matcher->getTrainDescriptors().size());
    matcher->clear();
    EXPECT_TRUE(matcher->levelSizes().empty());
    matcher->add(randomDescriptors(3, 4, 64));
    EXPECT_EQ(std::vector<int>(1, 64), matcher->levelSizes());
}

TEST(IIB_MatcherCreate, any_width_in_calls_with_two_sets)
{
    const Ptr<HierarchicalMatcher> matcher = HierarchicalMatcher::create();
    DescriptorMatcher& base = *matcher;
    for (int bytes : {32, 64, 61, 1})
    {
        const Mat queries = randomDescriptors(1, 20, bytes), trains = randomDescriptors(2, 30, bytes);
        std::vector<DMatch> expected, actual, throughBase;
        BFMatcher(NORM_HAMMING).match(queries, trains, expected);
        matcher->match(queries, trains, actual);
        base.match(queries, trains, throughBase);
        expectEqual(Matches(1, expected), Matches(1, actual));
        expectEqual(Matches(1, expected), Matches(1, throughBase));
        Mat indices, distances;
        matcher->knnMatchArrays(queries, trains, indices, distances, 2);
        EXPECT_EQ(20, indices.rows);
        EXPECT_THROW(matcher->match(queries, randomDescriptors(2, 3, bytes + 1), actual), cv::Exception);
        if (bytes == 64)
            matcher->add(trains);  // its own set has no say in calls with another
    }
    EXPECT_EQ(std::vector<int>(1, 64), matcher->levelSizes());
}

TEST(IIB_MatcherCreate, without_rows)
{
    const Ptr<HierarchicalMatcher> matcher = HierarchicalMatcher::create();
    Matches matches;
    matcher->add(std::vector<Mat>(2));
    matcher->knnMatch(randomDescriptors(1, 5, 32), matches, 1, std::vector<Mat>(2));
    expectEqual(Matches(5), matches);
    matcher->knnMatch(randomDescriptors(1, 5, 32), Mat(), matches, 1);
    expectEqual(Matches(5), matches);
    std::vector<DMatch> best(3);
    matcher->match(Mat(), Mat(), best);
    EXPECT_TRUE(best.empty());
    EXPECT_EQ(2u, matcher->getTrainDescriptors().size());
    EXPECT_TRUE(matcher->clone().dynamicCast<HierarchicalMatcher>()->levelSizes().empty());
    EXPECT_THROW(matcher->knnMatch(Mat(3, 8, CV_32F, Scalar(0)), matches, 1), cv::Exception);
    const TemporaryFile file;
    expectError(Error::StsBadArg, "nothing to save", [&] { matcher->saveIndex(file.name); });
    matcher->add(randomDescriptors(1, 4, 16));
    matcher->saveIndex(file.name);
    const std::vector<Mat> images = HierarchicalMatcher::loadIndex(file.name)->getTrainDescriptors();
    ASSERT_EQ(3u, images.size());
    EXPECT_EQ(4, images[2].rows);
}

// New, with an image without rows, and cleared.
TEST(IIB_MatcherClone, of_a_matcher_without_rows)
{
    const Mat codes = randomDescriptors(1, 5, 42);
    for (int setting = 0; setting < 3; setting++)
    {
        SCOPED_TRACE(setting);
        const Ptr<HierarchicalMatcher> matcher = HierarchicalMatcher::create({2, 8, 32});
        if (setting > 0)
            matcher->add(setting == 1 ? Mat() : codes);
        if (setting == 2)
            matcher->clear();
        Ptr<HierarchicalMatcher> copy;
        ASSERT_NO_THROW(copy = matcher->copy());
        ASSERT_NO_THROW(matcher->clone(false));
        EXPECT_EQ(matcher->getTrainDescriptors().size(), copy->getTrainDescriptors().size());
        EXPECT_EQ(matcher->levelSizes(), copy->levelSizes());
        copy->add(codes);
        std::vector<DMatch> matches;
        copy->match(codes, matches);
        EXPECT_EQ(5u, matches.size());
        EXPECT_TRUE(matcher->empty() || setting == 1);
    }
}

TEST(IIB_MatcherCreate, recommended)
{
    const Ptr<HierarchicalMatcher> matcher = HierarchicalMatcher::createRecommended();
    EXPECT_TRUE(matcher->levelSizes().empty());
    EXPECT_EQ(HierarchicalMatcher::EXACT, matcher->getMode());
    EXPECT_TRUE(matcher->getCrossCheck());
    EXPECT_EQ(0.92f, matcher->getMaxRatio());
    expectSameParameters(*matcher, *matcher->copy());

    MatcherOracle oracle;
    oracle.levelSizes.assign(1, 128);
    oracle.images.push_back(randomDescriptors(2, 70, 128));
    oracle.crossCheck = true;
    oracle.maxRatio = 0.92f;
    const Mat queries = randomDescriptors(1, 50, 128);
    matcher->add(oracle.images);
    expectKnnAsOracle(*matcher, oracle, queries, 1);
    EXPECT_FALSE(oracle.knn(queries, 1).empty());

    const TemporaryFile file;
    matcher->saveIndex(file.name);
    const Ptr<HierarchicalMatcher> loaded = HierarchicalMatcher::loadIndex(file.name);
    expectSameParameters(*matcher, *loaded);
    expectKnnAsOracle(*loaded, oracle, queries, 1);
}

// Files of Algorithm::save and of DescriptorMatcher::write, each read by both calls.
TEST(IIB_MatcherCreate, save_write_load_and_read_in_all_directions)
{
    const Ptr<HierarchicalMatcher> unusual =
            HierarchicalMatcher::create({8, 24}, HierarchicalMatcher::ADAPTIVE, 0.3f, true);
    unusual->setMaxRatio(0.75f);
    int named = 0;
    for (const Ptr<HierarchicalMatcher>& matcher :
            {unusual, HierarchicalMatcher::create(), HierarchicalMatcher::createRecommended()})
        forEachFileOf<DescriptorMatcher>(*matcher, [&](const String& file) {
            const Ptr<HierarchicalMatcher> loaded = Algorithm::load<HierarchicalMatcher>(file);
            ASSERT_FALSE(!loaded);
            expectSameParameters(*matcher, *loaded);
            const Ptr<HierarchicalMatcher> parsed =
                    Algorithm::loadFromString<HierarchicalMatcher>(readFile(file));
            ASSERT_FALSE(!parsed);
            expectSameParameters(*matcher, *parsed);
            const Ptr<HierarchicalMatcher> other = HierarchicalMatcher::create({4});
            other->read(file);
            expectSameParameters(*matcher, *other);
            if (FileStorage(file, FileStorage::READ)["HierarchicalMatcher"].empty())
                return;
            named++;
            expectSameParameters(
                    *matcher, *Algorithm::load<HierarchicalMatcher>(file, "HierarchicalMatcher"));
        });
    EXPECT_EQ(9, named) << "of three matchers, save() writes three formats";
    EXPECT_THROW(Algorithm::load<HierarchicalMatcher>("missing.yml"), cv::Exception);
    expectError(Error::StsParseError, "BRISK", [] {
        Algorithm::loadFromString<HierarchicalMatcher>("%YAML:1.0\n---\nBRISK:\n   octaves: 3\n");
    });
}

}}  // namespace opencv_test
