// SPDX-License-Identifier: Apache-2.0

#include "index_fixture.hpp"
#include "opencv2/iib/detail/files.hpp"

#include <atomic>
#include <thread>

#ifdef __linux__
#include <csignal>
#include <fcntl.h>
#include <sys/file.h>
#include <sys/wait.h>
#include <unistd.h>
#endif

namespace opencv_test { namespace {
using cv::iib::FileLock;

struct IIB_MappedIndex_Commits : public IndexFixture
{
};

TEST_F(IIB_MappedIndex_Commits, writers_at_the_same_time_lose_nothing)
{
    std::vector<std::thread> writers;
    for (int i = 0; i < 4; i++)
        writers.push_back(std::thread([&, i] {
            const Ptr<MappedIndex> own = MappedIndex::open(folder.name);
            for (int n = 0; n < 5; n++)
                own->add(Mat(1, BYTES, CV_8U, Scalar(i * 5 + n)));
        }));
    for (std::thread& writer : writers)
        writer.join();
    index->refresh();
    ASSERT_EQ(28, index->images());
    std::set<int> values;
    for (int image = 8; image < 28; image++)
        values.insert(index->descriptors(image).at<uchar>(0, 0));
    EXPECT_EQ(20u, values.size());
}

TEST_F(IIB_MappedIndex_Commits, create_needs_an_empty_folder)
{
    for (const char* name : {"thesis.tmp", ".hidden", "segment-000001.iib"})
    {
        const TemporaryFolder other;
        writeFile(other.name + "/" + name, "a year of work");
        expectError(Error::StsBadArg, name, [&] { MappedIndex::create(other.name, LEVELS); });
        std::vector<String> left;
        utils::fs::glob_relative(other.name, "", left);
        EXPECT_EQ(std::vector<String>(1, name), left);
        EXPECT_EQ("a year of work", readFile(other.name + "/" + name));
    }
    const TemporaryFolder other;
    utils::fs::createDirectory(other.name + "/photographs");
    expectError(Error::StsBadArg, "photographs", [&] { MappedIndex::create(other.name, LEVELS); });
    expectError(Error::StsBadArg, "already", [&] { MappedIndex::create(folder.name, LEVELS); });
}

TEST_F(IIB_MappedIndex_Commits, create_accepts_leftovers_of_a_killed_one)
{
    const TemporaryFolder other;
    writeFile(other.name + "/lock", "");
    writeFile(other.name + "/manifest.iib.123-0.tmp", "IIBSH");
    MappedIndex::create(other.name, LEVELS)->add(queries);
    EXPECT_EQ(1, MappedIndex::open(other.name)->images());
}

TEST_F(IIB_MappedIndex_Commits, writers_remove_only_unfinished_files_of_the_index)
{
    const std::vector<String> others = {"thesis.tmp", "saved.iib.12-0.tmp", "segment-000001.iib.tmp",
            "segment-1.iib.12-0.tmp", "segment-000001.iib.12-0.tmp.old", "my-segment-000001.iib.12-0.tmp",
            "manifest.iib.12-.tmp"};
    const std::vector<String> own = {
            "manifest.iib.12-0.tmp", "segment-000001.iib.99999-345.tmp", "segment-1234567.iib.1-2.tmp"};
    for (const std::vector<String>& names : {others, own})
        for (const String& name : names)
            writeFile(folder.name + "/" + name, "x");
    index->add(queries);
    for (const String& name : others)
        EXPECT_EQ("x", readFile(folder.name + "/" + name)) << name;
    for (const String& name : own)
        EXPECT_FALSE(utils::fs::exists(folder.name + "/" + name)) << name;
}

TEST_F(IIB_MappedIndex_Commits, remove_refers_to_the_last_commit)
{
    MappedIndex::open(folder.name)->add(queries);
    index->remove({8});
    expectError(Error::StsOutOfRange, "image 9", [&] { index->remove({0, 9}); });
    expectError(Error::StsOutOfRange, "image -1", [&] { index->remove({-1}); });

    utils::fs::remove_all(folder.name);
    MappedIndex::create(folder.name, LEVELS)->add(queries);
    expectError(Error::StsOutOfRange, "image 7", [&] { index->remove({7}); });
    EXPECT_EQ(1, MappedIndex::open(folder.name)->images());
    index->remove({0});
    EXPECT_EQ(1, index->images());
    EXPECT_EQ(-1, search(*index, queries, 1).rows[0]);
}

// Locking must not make the folder again: it would be in the way of a new index.
TEST_F(IIB_MappedIndex_Commits, a_removed_folder_is_not_made_again_by_locking)
{
    const String gone = folder.name + "/gone", file = folder.name + "/lock";
    for (const String& name : {gone, file})
        expectError(Error::StsError, name, [&] { FileLock(name, FileLock::OUTPUT_FOLDER); });
    EXPECT_FALSE(utils::fs::exists(gone));
    const FileLock lock(folder.name, FileLock::OUTPUT_FOLDER);
    expectError(Error::StsError, "another process", [&] { FileLock(folder.name, FileLock::OUTPUT_FOLDER); });
}

#ifdef __linux__
// A forked child inherits open files, including the lock.
TEST_F(IIB_MappedIndex_Commits, a_child_forked_meanwhile_does_not_keep_the_lock)
{
    const Mat many = randomDescriptors(7, 200000, BYTES);
    const int lock = open((folder.name + "/lock").c_str(), O_RDWR | O_CLOEXEC);
    ASSERT_GE(lock, 0);
    std::atomic<bool> done(false);
    std::thread writer([&] {
        index->add(many);
        done = true;
    });
    while (!done && flock(lock, LOCK_EX | LOCK_NB) == 0)
        flock(lock, LOCK_UN);
    const pid_t child = fork();
    if (child == 0)
    {
        alarm(600);  // ends the child if the test ends first
        for (;;)
            pause();
    }
    writer.join();
    EXPECT_EQ(0, flock(lock, LOCK_EX | LOCK_NB));
    close(lock);
    kill(child, SIGKILL);
    waitpid(child, 0, 0);
}

// A process that got the lock of a removed file must wait for the new file's lock, such as that of an index made again.
TEST_F(IIB_MappedIndex_Commits, a_lock_on_a_removed_file_does_not_count)
{
    const String name = folder.name + "/lock";
    const auto timesOpened = [&] {
        int times = 0;
        char target[1000];
        for (int file = 0; file < 1000; file++)
        {
            const ssize_t size = readlink(format("/proc/self/fd/%d", file).c_str(), target, sizeof(target));
            times += size == (ssize_t)name.size() && name.compare(0, size, target, size) == 0;
        }
        return times;
    };
    for (bool again : {false, true})
    {
        Ptr<FileLock> lock = makePtr<FileLock>(name, FileLock::LOCK_FILE), next;
        std::atomic<bool> held(false);
        std::thread waiting([&] {
            const FileLock own(name, FileLock::LOCK_FILE);
            held = true;
        });
        while (timesOpened() < 2)
            usleep(1000);
        std::remove(name.c_str());
        if (again)
            next = makePtr<FileLock>(name, FileLock::LOCK_FILE);
        lock.release();
        while (again && timesOpened() < 2)
            usleep(1000);
        EXPECT_FALSE(again && held);
        next.release();
        waiting.join();
        EXPECT_TRUE(held);
    }
    Ptr<FileLock> lock = makePtr<FileLock>(name, FileLock::LOCK_FILE);
    std::thread waiting([&] {
        expectError(Error::StsError, "check the folder", [&] { FileLock(name, FileLock::LOCK_FILE); });
    });
    while (timesOpened() < 2)
        usleep(1000);
    utils::fs::remove_all(folder.name);
    lock.release();
    waiting.join();
}

// The file is replaced between open() and flock(); no process holds its lock.
TEST_F(IIB_MappedIndex_Commits, an_output_that_another_process_replaces_is_not_in_use)
{
    const String name = folder.name + "/output", next = folder.name + "/next";
    std::atomic<bool> done(false);
    std::thread replacing([&] {
        while (!done)
        {
            close(open(next.c_str(), O_CREAT | O_WRONLY | O_CLOEXEC, 0666));
            EXPECT_EQ(0, std::rename(next.c_str(), name.c_str()));
            usleep(100);  // else no lock would be in time
        }
    });
    for (int times = 0; times < 5000; times++)
        EXPECT_NO_THROW(FileLock(name, FileLock::OUTPUT_FILE));
    done = true;
    replacing.join();
}

TEST_F(IIB_MappedIndex_Commits, full_disk_keeps_the_last_commit)
{
    for (rlim_t bytes : {50, 3000, 5000})
    {
        const FullDisk full(bytes);
        EXPECT_THROW(index->add(randomDescriptors(50, 1000, BYTES)), cv::Exception);
    }
    {
        const FullDisk full(100);
        EXPECT_THROW(index->remove({0}), cv::Exception);
    }
    EXPECT_TRUE(expected(images, queries, 3) == search(*index, queries, 3));
    EXPECT_TRUE(expected(images, queries, 3) == search(*MappedIndex::open(folder.name), queries, 3));
    index->add(queries);
    EXPECT_EQ(9, MappedIndex::open(folder.name)->images());
}

TEST_F(IIB_MappedIndex_Commits, killed_writers_leave_whole_commits)
{
    int64 count = index->images();
    for (int delay = 0; delay < 20; delay++)
    {
        const pid_t writer = fork();
        if (writer == 0)
            for (;;)  // until the child is killed
                MappedIndex::open(folder.name)->add(images[0]);
        ASSERT_GT(writer, 0);
        while (index->images() == count)  // until the child has committed an image
            index->refresh();
        usleep(delay * 300);
        kill(writer, SIGKILL);
        waitpid(writer, 0, 0);
        index->refresh();
        EXPECT_GT(index->images(), count);
        count = index->images();
        search(*index, queries, 1);
    }
    index->add(images[0]);
    std::vector<String> unfinished;
    cv::glob(folder.name + "/*.tmp", unfinished);
    EXPECT_TRUE(unfinished.empty());
    for (int64 image = images.size(); image < index->images(); image++)
        ASSERT_EQ(0, cvtest::norm(images[0], index->descriptors(image), NORM_INF));
}
#endif

}}  // namespace opencv_test
