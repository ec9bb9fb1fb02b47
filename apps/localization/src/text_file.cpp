// SPDX-License-Identifier: Apache-2.0

#include "text_file.hpp"

#include <charconv>
#include <cmath>

namespace iib_localization {

TextFile::TextFile(const std::string& path, char separator)
    : path_(path), stream_(path), separator_(separator)
{
    if (!stream_)
        CV_Error(cv::Error::StsError, path + " cannot be opened");
}

bool TextFile::next(Empty empty)
{
    std::string line;
    while (std::getline(stream_, line))
    {
        line_++;
        if (!line.empty() && line.back() == '\r')
            line.pop_back();
        if (!line.empty() && line[0] == '#')
            continue;
        words_.clear();
        for (size_t from = 0; from < line.size();)
        {
            const size_t to = std::min(line.find(separator_, from), line.size());
            // blanks may be repeated; two commas have an empty word between them
            if (to > from || separator_ != ' ')
                words_.push_back(line.substr(from, to - from));
            from = to + 1;
        }
        if (!words_.empty() || empty == KEEP)
            return true;
    }
    return false;
}

const std::string& TextFile::word(size_t i) const
{
    if (i >= words_.size())
        fail(cv::format("%d values, more are needed", int(words_.size())));
    return words_[i];
}

double TextFile::number(size_t i) const
{
    const std::string& text = word(i);
    double value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(value))
        fail("'" + text + "' is no number");
    return value;
}

int64_t TextFile::whole(size_t i, int64_t low, int64_t high) const
{
    const std::string& text = word(i);
    int64_t value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || end != text.data() + text.size() || value < low || value > high)
        fail("'" + text + "' is no whole number from " + std::to_string(low) + " to " + std::to_string(high));
    return value;
}

void TextFile::fail(const std::string& what) const
{
    CV_Error(cv::Error::StsParseError, path_ + ":" + std::to_string(line_) + ": " + what);
}

std::string shortest(double value)
{
    char text[32];
    return std::string(text, std::to_chars(text, text + sizeof(text), value).ptr);
}

std::ofstream createFile(const std::string& path)
{
    std::ofstream stream(path);
    if (!stream)
        CV_Error(cv::Error::StsError, path + " cannot be written");
    return stream;
}

void finishFile(std::ofstream& stream, const std::string& path)
{
    stream.close();
    if (!stream)
        CV_Error(cv::Error::StsError, path + " cannot be written to its end");
}

}  // namespace iib_localization
