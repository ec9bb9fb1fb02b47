// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#include "../support/matcher_oracle.hpp"
#include "../support/temporary_file.hpp"

namespace opencv_test {
namespace {

TEST(IIB_MatcherFile, comes_back_whole)
{
    const TemporaryFile file;
    const Ptr<HierarchicalMatcher> matcher =
            HierarchicalMatcher::create({3, 8, 31}, HierarchicalMatcher::THRESHOLD);
    matcher->setThresholds({0.4f, 0.45f});
    matcher->setMaxRatio(0.9f);
    matcher->add(std::vector<Mat>{randomDescriptors(1, 33, 42), Mat(), randomDescriptors(2, 5, 42)});
    matcher->saveIndex(file.name);
    const Ptr<HierarchicalMatcher> loaded = HierarchicalMatcher::loadIndex(file.name);
    EXPECT_EQ(matcher->levelSizes(), loaded->levelSizes());
    EXPECT_EQ(matcher->getThresholds(), loaded->getThresholds());
    EXPECT_EQ(matcher->getMode(), loaded->getMode());
    EXPECT_EQ(matcher->getMaxRatio(), loaded->getMaxRatio());
    EXPECT_EQ(matcher->getCrossCheck(), loaded->getCrossCheck());
    ASSERT_EQ(3u, loaded->getTrainDescriptors().size());
    EXPECT_EQ(0, cvtest::norm(matcher->getTrainDescriptors()[2], loaded->getTrainDescriptors()[2], NORM_INF));
    Matches expected, actual;
    const Mat queries = randomDescriptors(3, 20, 42);
    const std::vector<Mat> masks = {randomMask(4, 20, 33, 0.5), Mat(), Mat()};
    matcher->knnMatch(queries, expected, 3, masks);
    loaded->knnMatch(queries, actual, 3, masks);
    expectEqual(expected, actual);
}

TEST(IIB_MatcherFile, truncated_altered_or_foreign_throws)
{
    const TemporaryFile file;
    const Ptr<HierarchicalMatcher> matcher = HierarchicalMatcher::create({2, 6});
    matcher->add(randomDescriptors(1, 3, 8));
    matcher->saveIndex(file.name);
    const std::string whole = file.read();
    for (size_t size = 0; size < whole.size(); size++)
    {
        file.write(whole.substr(0, size));
        EXPECT_THROW(HierarchicalMatcher::loadIndex(file.name), cv::Exception) << size;
        std::string altered = whole;
        for (int change : {1, 128, 255})
        {
            altered[size] = (char)(whole[size] ^ change);
            file.write(altered);
            EXPECT_THROW(HierarchicalMatcher::loadIndex(file.name), cv::Exception) << size;
        }
    }
    file.write(whole + "x");
    EXPECT_THROW(HierarchicalMatcher::loadIndex(file.name), cv::Exception);
    file.write("%YAML:1.0\n---\nlevelSizes: [ 2, 8 ]\n");
    EXPECT_THROW(HierarchicalMatcher::loadIndex(file.name), cv::Exception);
    EXPECT_THROW(HierarchicalMatcher::loadIndex(file.name + ".missing"), cv::Exception);
    EXPECT_THROW(matcher->saveIndex(file.name + ".missing/file"), cv::Exception);
    file.write(whole);
    EXPECT_EQ(3, HierarchicalMatcher::loadIndex(file.name)->getTrainDescriptors()[0].rows);
}

// A file as format 1 wrote it: levels {1, 2}, THRESHOLD at 0.25, cross-check, ratio 0.5, an image of two rows.
TEST(IIB_MatcherFile, format_1_stays_readable)
{
    const uchar bytes[] = {'I', 'I', 'B', 'I', 'N', 'D', 'E', 'X', 1, 0, 0, 0, 2, 0, 0, 0, 1, 0, 0, 0, 2, 0,
            0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0, 63, 0, 0, 128, 62, 1, 0, 0, 0, 0, 0, 0, 0, 2, 0, 0, 0, 0,
            0, 0, 0, 1, 2, 3, 250, 251, 252, 208, 162, 232, 181, 226, 157, 225, 67};
    const TemporaryFile file;
    file.write(std::string((const char*)bytes, sizeof(bytes)));
    const Ptr<HierarchicalMatcher> matcher = HierarchicalMatcher::loadIndex(file.name);
    EXPECT_EQ((std::vector<int>{1, 2}), matcher->levelSizes());
    EXPECT_EQ(HierarchicalMatcher::THRESHOLD, matcher->getMode());
    EXPECT_EQ(std::vector<float>(1, 0.25f), matcher->getThresholds());
    EXPECT_TRUE(matcher->getCrossCheck());
    EXPECT_EQ(0.5f, matcher->getMaxRatio());
    const Mat expected = (Mat_<uchar>(2, 3) << 1, 2, 3, 250, 251, 252);
    EXPECT_EQ(0, cvtest::norm(expected, matcher->getTrainDescriptors()[0], NORM_INF));
    matcher->saveIndex(file.name);
    EXPECT_EQ(std::string((const char*)bytes, sizeof(bytes)), file.read());
}

TEST(IIB_MatcherFile, parameters_through_file_storage)
{
    const Ptr<HierarchicalMatcher> matcher =
            HierarchicalMatcher::create({8, 24}, HierarchicalMatcher::ADAPTIVE, 0.3f, true);
    matcher->setMaxRatio(0.75f);
    FileStorage out(".yml", FileStorage::WRITE | FileStorage::MEMORY);
    matcher->write(out);
    FileStorage in(out.releaseAndGetString(), FileStorage::READ | FileStorage::MEMORY);
    const Ptr<HierarchicalMatcher> other = HierarchicalMatcher::create({4});
    other->read(in.root());
    EXPECT_EQ(matcher->levelSizes(), other->levelSizes());
    EXPECT_EQ(HierarchicalMatcher::ADAPTIVE, other->getMode());
    EXPECT_EQ(matcher->getThresholds(), other->getThresholds());
    EXPECT_TRUE(other->getCrossCheck());
    EXPECT_EQ(0.75f, other->getMaxRatio());
}

// Parameters as the first version wrote them.
TEST(IIB_MatcherFile, first_parameters_stay_readable)
{
    const FileStorage in(
            "%YAML:1.0\n---\nlevelSizes: [ 8, 24 ]\nmode: 2\nthresholds: [ 3.0000001192092896e-01 ]\n"
            "crossCheck: 1\nmaxRatio: 7.5000000000000000e-01\n",
            FileStorage::READ | FileStorage::MEMORY);
    const Ptr<HierarchicalMatcher> matcher = HierarchicalMatcher::create({4});
    matcher->read(in.root());
    EXPECT_EQ((std::vector<int>{8, 24}), matcher->levelSizes());
    EXPECT_EQ(HierarchicalMatcher::ADAPTIVE, matcher->getMode());
    EXPECT_EQ(std::vector<float>(1, 0.3f), matcher->getThresholds());
    EXPECT_TRUE(matcher->getCrossCheck());
    EXPECT_EQ(0.75f, matcher->getMaxRatio());
}

}  // namespace
}  // namespace opencv_test
