// SPDX-License-Identifier: Apache-2.0

#include <sched.h>
#include <sys/mount.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <filesystem>

#include "images.hpp"
#include "new_folder.hpp"
#include "iib_geometry/test/wall.hpp"

namespace {
using namespace opencv_test;
using namespace iib_localization;

const std::vector<std::string> OWN = {"index", "[a-z].part", "sub/", "sub/?.part"};

void publish(const std::string& target, const std::string& text)
{
    NewFolder made(target, OWN);
    std::ofstream(made.path() + "/index") << text;
    made.publish();
}

TEST(NewFolder, appears_whole_and_replaces_its_like)
{
    const TestFolder folder;
    const std::string target = folder.path("a/b/out");
    {
        const NewFolder unfinished(target, OWN);
        std::ofstream(unfinished.path() + "/index") << "half";
    }
    EXPECT_FALSE(cv::utils::fs::exists(target));
    EXPECT_FALSE(cv::utils::fs::exists(target + ".iib_partial"));
    publish(target, "one");
    std::ofstream(target + "/o.part") << "old";
    publish(target + "/", "two");
    EXPECT_EQ("two", textOf(target + "/index"));
    EXPECT_FALSE(cv::utils::fs::exists(target + "/o.part"));
    for (const char* left : {".iib_partial", ".iib_partial.old"})
        EXPECT_FALSE(cv::utils::fs::exists(target + left)) << left;
    folder.makeFolder("empty");
    publish(folder.path("empty"), "three");
    EXPECT_EQ("three", textOf(folder.path("empty/index")));
}

TEST(NewFolder, links)
{
    const TestFolder folder;
    folder.makeFolder("disk/out");
    std::filesystem::create_symlink("disk/out", folder.path("good"));
    publish(folder.path("good"), "one");
    EXPECT_TRUE(std::filesystem::is_symlink(folder.path("good"))) << "is followed";
    EXPECT_EQ("one", textOf(folder.path("disk/out/index")));
    std::filesystem::create_symlink("nowhere", folder.path("dangling"));
    EXPECT_EQ(folder.path("dangling") + " is a link to nothing: remove it",
            messageOf([&] { NewFolder(folder.path("dangling"), OWN); }));
    folder.makeFolder("precious");
    folder.write("precious/thesis", "precious");
    std::filesystem::create_symlink("precious", folder.path("new.iib_partial"));
    EXPECT_EQ(folder.path("new.iib_partial") + " is a link: remove it",
            messageOf([&] { NewFolder(folder.path("new"), OWN); }));
    EXPECT_EQ("precious", textOf(folder.path("precious/thesis")));
}

TEST(NewFolder, replaces_nothing_else)
{
    const TestFolder folder;
    const auto error = [&] { return messageOf([&] { publish(folder.path("out"), "new"); }); };
    folder.makeFolder("out");
    folder.write("out/a.part", "of something else");
    const std::string told = " and was not written by this program: choose another folder";
    EXPECT_EQ(folder.path("out") + " holds a.part" + told, error());
    folder.write("out/index", "old");
    EXPECT_EQ("", error());
    for (const char* name : {"holiday.png", ".hidden"})
    {
        folder.write(std::string("out/") + name, "precious");
        EXPECT_EQ(folder.path("out") + " holds " + name + told, error());
        EXPECT_EQ("precious", textOf(folder.path("out/") + name));
        std::remove((folder.path("out/") + name).c_str());
    }
    folder.makeFolder("out/sub");
    folder.write("out/sub/a.part", "old");
    EXPECT_EQ("", error());
    folder.makeFolder("out/sub");
    folder.write("out/sub/thesis", "precious");
    EXPECT_NE(std::string::npos, error().find(" holds sub/thesis" + told)) << error();
    EXPECT_EQ("precious", textOf(folder.path("out/sub/thesis")));
    folder.write("file", "precious");
    EXPECT_NE("", messageOf([&] { publish(folder.path("file"), "new"); }));
    EXPECT_EQ("precious", textOf(folder.path("file")));

    EXPECT_EQ("/proc is a mount point: give a folder inside it", messageOf([&] { NewFolder("/proc", OWN); }));
}

// Of the same file system: only the kernel tells.
TEST(NewFolder, bind_mounts)
{
    const TestFolder folder;
    folder.makeFolder("out");
    const std::string out = folder.path("out");
    constexpr int NO_RIGHT = 77;
    const pid_t child = ::fork();  // whose mounts go with it
    if (child == 0)
    {
        if (::unshare(CLONE_NEWUSER | CLONE_NEWNS) != 0 ||
                ::mount(out.c_str(), out.c_str(), nullptr, MS_BIND, nullptr) != 0)
            ::_exit(NO_RIGHT);
        const std::string error = messageOf([&] { NewFolder(out, OWN); });
        ::_exit(error == out + " is a mount point: give a folder inside it" ? 0 : 1);
    }
    int status = 0;
    ASSERT_EQ(child, ::waitpid(child, &status, 0));
    if (WEXITSTATUS(status) == NO_RIGHT)
        throw cvtest::SkipTestException("this user may mount nothing");
    EXPECT_EQ(0, status);
}

// The file system's own exceptions are no cv::Exception.
TEST(NewFolder, that_cannot_be_made)
{
    const TestFolder folder;
    folder.write("file", "");
    std::filesystem::create_symlink("loop", folder.path("loop"));
    EXPECT_EQ(folder.path("file/out") + " cannot be written: Not a directory",
            messageOf([&] { NewFolder(folder.path("file/out"), OWN); }));
    EXPECT_EQ(folder.path("loop/out") + " cannot be written: Too many levels of symbolic links",
            messageOf([&] { NewFolder(folder.path("loop/out"), OWN); }));
}

TEST(Images, folders_that_cannot_be_read)
{
    const TestFolder folder;
    folder.makeFolder("locked");
    folder.write("0.png", "");
    std::filesystem::create_symlink("loop", folder.path("loop"));
    const std::string told = " or a folder in it cannot be read: ";
    EXPECT_EQ(folder.path("loop") + told + "Too many levels of symbolic links",
            messageOf([&] { listImages(folder.path("loop")); }));
    const bool root = ::geteuid() == 0;
    ASSERT_EQ(0, ::chmod(folder.path("locked").c_str(), 0));
    ASSERT_EQ(0, root ? ::seteuid(65534) : 0) << "root may read everything";
    const std::string error = messageOf([&] { listImages(folder.path("")); });
    ASSERT_EQ(0, root ? ::seteuid(0) : 0);
    ::chmod(folder.path("locked").c_str(), 0700);
    EXPECT_EQ(folder.path("") + told + "Permission denied", error);
}

TEST(NewFolder, what_a_killed_run_left_is_removed_but_not_what_is_being_written)
{
    const TestFolder folder;
    folder.makeFolder("out.iib_partial");
    folder.write("out.iib_partial/l.part", "of a killed run");
    folder.makeFolder("out");
    folder.makeFolder("out.iib_partial.old/sub");
    NewFolder one(folder.path("out"), OWN);
    EXPECT_FALSE(cv::utils::fs::exists(folder.path("out.iib_partial/l.part")));
    std::ofstream(one.path() + "/index") << "one";
    EXPECT_EQ(folder.path("out") + " is being written by another process: wait until it has ended",
            messageOf([&] { publish(folder.path("out"), "other"); }));
    one.publish();
    EXPECT_EQ("one", textOf(folder.path("out/index")));
    EXPECT_FALSE(cv::utils::fs::exists(folder.path("out.iib_partial.old")));
}

TEST(Images, names_that_results_cannot_hold)
{
    const TestFolder folder;
    folder.makeFolder("b");
    for (const char* name : {"a b.png", "a,b.PNG", "a\"b.jpg", "b/#1.png", "b/0.jpg", "0.png", "notes.txt"})
        folder.write(name, "");
    const std::vector<std::string> expected = {
            "0.png", "a b.png", "a\"b.jpg", "a,b.PNG", "b/#1.png", "b/0.jpg"};
    EXPECT_EQ(expected, listImages(folder.path("")));
    const TestFolder links;
    std::filesystem::create_symlink(folder.path("0.png"), links.path("2.png"));
    EXPECT_EQ(std::vector<std::string>{"2.png"}, listImages(links.path(""))) << "by its name here";
    folder.write("b/0.png", "");
    EXPECT_EQ("b/0.png and b/0.jpg would have one pose: rename one of them",
            messageOf([&] { listImages(folder.path("")); }));
    folder.write("#a.png", "");
    EXPECT_EQ("#a.png: rename it, without a leading # and line breaks: a trajectory cannot hold these",
            messageOf([&] { listImages(folder.path("")); }));
    EXPECT_EQ(folder.path("none") + " or a folder in it cannot be read: No such file or directory",
            messageOf([&] { listImages(folder.path("none")); }));
}

}  // namespace
