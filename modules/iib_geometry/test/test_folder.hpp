// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <fstream>
#include <string>

#include "opencv2/core.hpp"
#include "opencv2/core/utils/filesystem.hpp"
#include "opencv2/ts.hpp"

//! A temporary folder, removed with the object.
class TestFolder
{
public:
    TestFolder() : path_(cv::tempfile()) { cv::utils::fs::createDirectories(path_); }
    ~TestFolder() { std::filesystem::remove_all(path_); }
    TestFolder(const TestFolder&) = delete;
    TestFolder& operator=(const TestFolder&) = delete;

    std::string path(const std::string& name) const { return path_ + "/" + name; }
    void makeFolder(const std::string& name) const { cv::utils::fs::createDirectories(path(name)); }
    void write(const std::string& name, const std::string& text) const
    {
        std::filesystem::remove(path(name));  // overwriting a file would wait for the disk on ext4
        std::ofstream(path(name), std::ios::binary) << text;
    }

private:
    std::string path_;
};

//! The message of the cv::Exception that a statement throws; empty if it throws none.
template <typename Statement> std::string messageOf(Statement statement)
{
    try
    {
        statement();
    }
    catch (const cv::Exception& e)
    {
        return e.err;
    }
    return "";
}

//! Expects that the folder is locked by another process. On Windows the message goes on with the file to remove.
template <typename Statement> void expectAnotherWrites(const std::string& folder, Statement statement)
{
    const std::string message = messageOf(statement);
    EXPECT_EQ(0u, message.find(folder + " is being written by another process: wait until it has ended"))
            << message;
}
