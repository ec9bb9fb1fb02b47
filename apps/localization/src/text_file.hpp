// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fstream>
#include <string>
#include <vector>

#include "opencv2/core.hpp"

namespace iib_localization {

/** Reads a text file as lines of words; lines that begin with # are left out.
@throws cv::Exception, with the name of the file and the line, for what is not as it should be. */
class TextFile
{
public:
    explicit TextFile(const std::string& path, char separator = ' ');

    enum Empty
    {
        SKIP,
        KEEP
    };
    //! Goes on to the next line; false at the end of the file.
    bool next(Empty empty = SKIP);
    size_t size() const { return words_.size(); }
    const std::string& word(size_t i) const;
    //! A finite number.
    double number(size_t i) const;
    int64_t whole(size_t i, int64_t low, int64_t high) const;
    [[noreturn]] void fail(const std::string& what) const;

private:
    std::string path_;
    std::ifstream stream_;
    char separator_;
    int line_ = 0;
    std::vector<std::string> words_;
};

//! The shortest decimal that reads back as the same number.
std::string shortest(double value);

//! A file to write text to. @throws cv::Exception if that is impossible.
std::ofstream createFile(const std::string& path);
//! Closes it. @throws cv::Exception if not all could be written.
void finishFile(std::ofstream& stream, const std::string& path);

}  // namespace iib_localization
