// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#include "../support/matcher_oracle.hpp"
#include "../support/temporary_file.hpp"
#include "../support/test_errors.hpp"

#include <atomic>
#include <thread>

#ifdef __linux__
#include <malloc.h>
#include <sys/stat.h>
#include <unistd.h>
#endif

namespace opencv_test { namespace {

Ptr<HierarchicalMatcher> matcherOf(int rows)
{
    const Ptr<HierarchicalMatcher> matcher = HierarchicalMatcher::create({2, 6});
    matcher->add(randomDescriptors(1, rows, 8));
    return matcher;
}

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
    expectSameParameters(*matcher, *loaded);
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
    matcherOf(3)->saveIndex(file.name);
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
    EXPECT_THROW(matcherOf(3)->saveIndex(file.name + ".missing/file"), cv::Exception);
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
    const Mat expected = Mat_<uchar>({2, 3}, {1, 2, 3, 250, 251, 252});
    EXPECT_EQ(0, cvtest::norm(expected, matcher->getTrainDescriptors()[0], NORM_INF));
    matcher->saveIndex(file.name);
    EXPECT_EQ(std::string((const char*)bytes, sizeof(bytes)), file.read());
}

TEST(IIB_IndexFile, load_never_sees_half_a_file)
{
    const TemporaryFile file;
    matcherOf(3)->saveIndex(file.name);
    const Ptr<HierarchicalMatcher> large = matcherOf(3000);
    std::atomic<bool> done(false);
    std::thread writer([&] {
        for (int i = 0; i < 50; i++)
            (i % 2 ? matcherOf(3) : large)->saveIndex(file.name);
        done = true;
    });
    int loads = 0;
    do
    {
        EXPECT_NO_THROW(HierarchicalMatcher::loadIndex(file.name));
        loads++;
    } while (!done || loads < 10);
    writer.join();
}

TEST(IIB_IndexFile, savers_at_the_same_time_leave_a_whole_file)
{
    const TemporaryFile file;
    std::vector<std::thread> writers;
    for (int i = 0; i < 4; i++)
        writers.push_back(std::thread([&, i] { matcherOf(1000 + i)->saveIndex(file.name); }));
    for (std::thread& writer : writers)
        writer.join();
    const int rows = HierarchicalMatcher::loadIndex(file.name)->getTrainDescriptors()[0].rows;
    EXPECT_TRUE(rows >= 1000 && rows < 1004) << rows;
}

#ifdef __linux__
TEST(IIB_IndexFile, full_disk_keeps_the_old_file)
{
    const TemporaryFolder folder;
    const String name = folder.name + "/index.iib";
    matcherOf(40)->saveIndex(name);
    {
        const FullDisk full(100);
        EXPECT_THROW(matcherOf(41)->saveIndex(name), cv::Exception);
        EXPECT_THROW(matcherOf(1000)->saveIndex(folder.name + "/new.iib"), cv::Exception);
    }
    EXPECT_EQ(40, HierarchicalMatcher::loadIndex(name)->getTrainDescriptors()[0].rows);
    std::vector<String> files;
    cv::glob(folder.name + "/*", files);
    EXPECT_EQ(std::vector<String>(1, name), files);  // no temporary file is left
}

TEST(IIB_IndexFile, pipes_links_and_rights_stay_what_they_are)
{
    const TemporaryFile file, link;
    matcherOf(1)->saveIndex(file.name);
    ASSERT_EQ(0, chmod(file.name.c_str(), 0640));
    ASSERT_EQ(0, symlink(file.name.c_str(), link.name.c_str()));
    matcherOf(2)->saveIndex(link.name);
    struct stat target, entry;
    ASSERT_EQ(0, lstat(link.name.c_str(), &entry));
    EXPECT_TRUE(S_ISLNK(entry.st_mode));
    ASSERT_EQ(0, stat(file.name.c_str(), &target));
    EXPECT_EQ(0640u, target.st_mode & 0777u);
    EXPECT_EQ(2, HierarchicalMatcher::loadIndex(file.name)->getTrainDescriptors()[0].rows);
    const TemporaryFolder folder;
    ASSERT_EQ(0, std::remove(file.name.c_str()));
    const String relative = folder.name + "/relative", circle = folder.name + "/circle";
    ASSERT_EQ(0, symlink("new.iib", relative.c_str()));
    for (const String& name : {link.name, relative})
    {
        matcherOf(3)->saveIndex(name);  // the file is made where the link leads, as by open()
        ASSERT_EQ(0, lstat(name.c_str(), &entry));
        EXPECT_TRUE(S_ISLNK(entry.st_mode));
    }
    for (const String& name : {file.name, folder.name + "/new.iib"})
        EXPECT_EQ(3, HierarchicalMatcher::loadIndex(name)->getTrainDescriptors()[0].rows);
    ASSERT_EQ(0, symlink("circle", circle.c_str()));
    expectError(Error::StsError, "in a circle", [&] { matcherOf(2)->saveIndex(circle); });
    const String pipe = folder.name + "/pipe";  // no device of the machine, which a mistake would replace
    ASSERT_EQ(0, mkfifo(pipe.c_str(), 0600));
    for (const String& name : {folder.name, pipe})
        expectError(Error::StsError, "a folder, a device or a pipe", [&] { matcherOf(2)->saveIndex(name); });
    ASSERT_EQ(0, lstat(pipe.c_str(), &entry));
    EXPECT_TRUE(S_ISFIFO(entry.st_mode));
}

TEST(IIB_IndexFile, pipes_and_folders_are_no_files)
{
    const TemporaryFolder folder;
    const String pipe = folder.name + "/pipe";
    ASSERT_EQ(0, mkfifo(pipe.c_str(), 0600));
    alarm(60);  // waiting for a writer would never end
    for (const String& name : {pipe, folder.name})
        expectError(Error::StsError, "Cannot read " + name, [&] { HierarchicalMatcher::loadIndex(name); });
    alarm(0);
}

// A C string ends at its first zero: another file would be opened.
TEST(IIB_IndexFile, names_are_bytes_without_a_zero)
{
    const TemporaryFolder folder;
    const String bytes = folder.name + "/\xff\xfe\x80.iib", zero = folder.name + String("/a\0b.yml", 8);
    matcherOf(3)->saveIndex(bytes);
    EXPECT_EQ(3, HierarchicalMatcher::loadIndex(bytes)->getTrainDescriptors()[0].rows);
    expectError(Error::StsBadArg, "a zero byte", [&] { matcherOf(3)->saveIndex(zero); });
    expectError(Error::StsBadArg, "a zero byte", [&] { HierarchicalMatcher::loadIndex(zero); });
    expectError(Error::StsBadArg, "a zero byte", [&] { matcherOf(3)->save(zero); });
    std::vector<String> files;
    cv::glob(folder.name + "/*", files);
    EXPECT_EQ(std::vector<String>(1, bytes), files);
}

// The name of the temporary file must not be longer.
TEST(IIB_IndexFile, names_as_long_as_the_system_takes_them)
{
    const TemporaryFolder folder;
    const String name = folder.name + "/" + String(255, 'x');
    for (int rows : {1, 2})
        matcherOf(rows)->saveIndex(name);
    EXPECT_EQ(2, HierarchicalMatcher::loadIndex(name)->getTrainDescriptors()[0].rows);
}
#endif

TEST(IIB_IndexFile, parameters_that_opencv_packs_are_read_and_not_written)
{
    const TemporaryFile file(".json.gz");
    expectError(Error::StsBadArg, "end its name in .yml", [&] { matcherOf(1)->save(file.name); });
    FileStorage packed(file.name, FileStorage::WRITE);
    HierarchicalMatcher::create({2, 6}, HierarchicalMatcher::ADAPTIVE)->write(packed);
    packed.release();
    EXPECT_EQ("\x1f\x8b", file.read().substr(0, 2));
    EXPECT_EQ(std::vector<int>({2, 6}), Algorithm::load<HierarchicalMatcher>(file.name)->levelSizes());
}

#if defined __GLIBC__ && (__GLIBC__ > 2 || __GLIBC_MINOR__ >= 33)
size_t bytesInUse()
{
    const struct mallinfo2 info = mallinfo2();
    return info.uordblks + info.hblkhd;
}

// DescriptorMatcher needs a matrix header for each image, and no more.
TEST(IIB_IndexFile, memory_of_empty_images)
{
    const TemporaryFile file;
    const int images = 500000;
    {
        const Ptr<HierarchicalMatcher> matcher = HierarchicalMatcher::create({2, 6});
        matcher->add(std::vector<Mat>(images));
        matcher->saveIndex(file.name);
    }
    const size_t before = bytesInUse();
    const Ptr<HierarchicalMatcher> loaded = HierarchicalMatcher::loadIndex(file.name);
    EXPECT_LT(bytesInUse() - before, images * (sizeof(Mat) + 34));
    EXPECT_EQ((size_t)images, loaded->getTrainDescriptors().size());
}

TEST(IIB_IndexFile, codes_are_held_once)
{
    const TemporaryFile file;
    const int rows = 100000, bytes = 64;
    const size_t once = (size_t)rows * bytes, start = bytesInUse();
    Mat codes = randomDescriptors(1, rows, bytes);
    const Ptr<HierarchicalMatcher> matcher = HierarchicalMatcher::create(std::vector<int>(1, bytes));
    matcher->add(codes);
    codes.release();
    EXPECT_LT(bytesInUse() - start, once + once / 4);
    matcher->saveIndex(file.name);
    const size_t before = bytesInUse();
    const Ptr<HierarchicalMatcher> loaded = HierarchicalMatcher::loadIndex(file.name);
    EXPECT_LT(bytesInUse() - before, once + once / 4);
    const size_t loadedToo = bytesInUse();
    const Ptr<DescriptorMatcher> copy = matcher->clone();
    EXPECT_LT(bytesInUse() - loadedToo, once + once / 4);
}
#endif

TEST(IIB_IndexFile, version_0_is_not_called_newer)
{
    const TemporaryFile file;
    matcherOf(1)->saveIndex(file.name);
    std::string bytes = file.read();
    bytes[8] = 0;
    file.write(bytes);
    expectError(Error::StsParseError, "format 0 does not exist",
            [&] { HierarchicalMatcher::loadIndex(file.name); });
    bytes[8] = 2;
    file.write(bytes);
    expectError(Error::StsParseError, "newer", [&] { HierarchicalMatcher::loadIndex(file.name); });
}

}}  // namespace opencv_test
