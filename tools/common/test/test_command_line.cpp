// SPDX-License-Identifier: Apache-2.0

#include "../command_line.hpp"
#include "iib_geometry/test/test_folder.hpp"

namespace {
using namespace iib_tools;

typedef std::vector<std::string> Words;

CommandLine lineOf(const Words& words)
{
    std::vector<const char*> argv(1, "tool");
    for (const std::string& word : words)
        argv.push_back(word.c_str());
    return CommandLine(int(argv.size()), argv.data(), "about",
            "{out|results|folder}{points|1000|number}{only|<none>|repeated}{fast||switch}");
}

TEST(CommandLine, both_spellings_of_a_value_and_positional_arguments_anywhere)
{
    const CommandLine line = lineOf({"a.png", "--points=7", "b.png", "--out", "x=y", "-fast"});
    EXPECT_EQ(Words({"a.png", "b.png"}), line.positional());
    EXPECT_EQ(7, line.whole("points", 1, 10));
    EXPECT_EQ("x=y", line.text("out"));
    EXPECT_TRUE(line.has("fast"));
    EXPECT_FALSE(line.has("help"));
    EXPECT_FALSE(line.has("only"));
    EXPECT_EQ("", line.text("only"));
    EXPECT_TRUE(lineOf({"-h"}).has("help"));
}

TEST(CommandLine, defaults_and_repetition)
{
    const CommandLine line = lineOf({"--only", "a", "--only=b"});
    EXPECT_EQ(Words({"a", "b"}), line.all("only"));
    EXPECT_EQ("b", line.text("only"));
    EXPECT_EQ("results", line.text("out"));
    EXPECT_EQ(1000, line.number("points", 1, 1e6));
    EXPECT_EQ(Words({"x"}), lineOf({"-out", "x"}).all("out"));
}

TEST(CommandLine, mistakes_are_reported)
{
    EXPECT_EQ("unknown option --point (--help lists them)", messageOf([] { lineOf({"--point=3"}); }));
    EXPECT_EQ("option --out needs a value", messageOf([] { lineOf({"--out"}); }));
    EXPECT_EQ("option --out needs a value", messageOf([] { lineOf({"--out="}); }));
    EXPECT_EQ("option --fast takes no value", messageOf([] { lineOf({"--fast=1"}); }));
    for (const char* wrong : {"--points=0", "--points=11", "--points=3x", "--points=nan", "--points=2.5"})
        EXPECT_NE("", messageOf([&] { lineOf({wrong}).whole("points", 1, 10); })) << wrong;
}

TEST(CommandLine, exit_codes)
{
    const auto codeOf = [](const char* word, int thrown) {
        const char* const argv[] = {"tool", word};
        return runTool(2, argv, "about", "{fast||switch}", [thrown](const CommandLine& line) {
            if (thrown)
                CV_Error(thrown, "message");
            return line.has("fast") ? 7 : 8;
        });
    };
    EXPECT_EQ(7, codeOf("--fast", 0));
    EXPECT_EQ(8, codeOf("file", 0));
    EXPECT_EQ(2, codeOf("--slow", 0));
    EXPECT_EQ(2, codeOf("file", cv::Error::StsBadArg));
    EXPECT_EQ(1, codeOf("file", cv::Error::StsError));
    EXPECT_EQ(0, codeOf("--help", cv::Error::StsError));
}

}  // namespace
