// SPDX-License-Identifier: Apache-2.0

#include "../src/images.hpp"
#include "../src/new_folder.hpp"
#include "common/test/test_folder.hpp"

namespace {
using namespace iib_localization;

const std::vector<std::string> OWN = {"index", "*.part"};

void publish(const std::string& target, const std::string& text)
{
    NewFolder made(target, OWN);
    std::ofstream(made.path() + "/index") << text;
    made.publish();
}

std::string textOf(const std::string& path)
{
    std::ifstream stream(path);
    return {std::istreambuf_iterator<char>(stream), {}};
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
    std::ofstream(target + "/old.part") << "old";
    publish(target + "/", "two");
    EXPECT_EQ("two", textOf(target + "/index"));
    EXPECT_FALSE(cv::utils::fs::exists(target + "/old.part"));
    EXPECT_FALSE(cv::utils::fs::exists(target + ".iib_partial"));
    folder.makeFolder("empty");
    publish(folder.path("empty"), "three");
    EXPECT_EQ("three", textOf(folder.path("empty/index")));
}

TEST(NewFolder, replaces_nothing_else)
{
    const TestFolder folder;
    const auto error = [&] { return messageOf([&] { publish(folder.path("out"), "new"); }); };
    folder.makeFolder("out");
    folder.write("out/a.part", "of something else");
    EXPECT_EQ(folder.path("out") + " holds a.part but no index, so that it is no result of this program: "
                                   "choose another folder",
            error());
    folder.write("out/index", "old");
    EXPECT_EQ("", error());
    for (const char* name : {"holiday.png", ".hidden"})
    {
        folder.write(std::string("out/") + name, "precious");
        EXPECT_EQ(folder.path("out") + " holds " + name +
                          ", which is no result of this program: choose another folder",
                error());
        EXPECT_EQ("precious", textOf(folder.path("out/") + name));
        std::remove((folder.path("out/") + name).c_str());
    }
    folder.makeFolder("out/folder.part");
    EXPECT_NE("", error());
    folder.write("file", "precious");
    EXPECT_NE("", messageOf([&] { publish(folder.path("file"), "new"); }));
    EXPECT_EQ("precious", textOf(folder.path("file")));

    EXPECT_EQ("/proc is a mount point: give a folder inside it", messageOf([&] { NewFolder("/proc", OWN); }));
}

TEST(NewFolder, what_a_killed_run_left_is_removed_but_not_what_is_being_written)
{
    const TestFolder folder;
    folder.makeFolder("out.iib_partial");
    folder.write("out.iib_partial/left.part", "of a killed run");
    NewFolder one(folder.path("out"), OWN);
    EXPECT_FALSE(cv::utils::fs::exists(folder.path("out.iib_partial/left.part")));
    std::ofstream(one.path() + "/index") << "one";
    EXPECT_EQ(folder.path("out") + " is being written by another process: wait until it has ended",
            messageOf([&] { publish(folder.path("out"), "other"); }));
    one.publish();
    EXPECT_EQ("one", textOf(folder.path("out/index")));
}

TEST(Images, names_that_results_cannot_hold)
{
    for (const char* name : {"a b.png", "a,b.png", "a\"b.png", "#a.png"})
    {
        const TestFolder folder;
        folder.write(name, "");
        EXPECT_EQ(folder.path(name) +
                          ": rename it, without blanks, commas, quotes and a leading #: files of poses "
                          "cannot hold these",
                messageOf([&] { listImages(folder.path("")); }));
    }
    const TestFolder folder;
    folder.write("0.jpg", "");
    folder.write("1.jpg", "");
    EXPECT_EQ(2u, listImages(folder.path("")).size());
    folder.write("0.png", "");
    EXPECT_EQ(folder.path("0.png") + " and 0.jpg would have one pose: rename one of them",
            messageOf([&] { listImages(folder.path("")); }));
}

}  // namespace
