// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#include "../support/matcher_oracle.hpp"
#include "../support/temporary_file.hpp"
#include "../support/test_errors.hpp"

namespace opencv_test {
namespace {

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

// Unless OpenCV cuts them to 32 bits before anyone can see it.
TEST(IIB_MatcherParameters, whole_numbers_beyond_32_bits)
{
    const FileStorage probe("%YAML:1.0\n---\nnumber: 4294967304\n", FileStorage::READ | FileStorage::MEMORY);
    if ((double)probe["number"] == 8)
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

}  // namespace
}  // namespace opencv_test
