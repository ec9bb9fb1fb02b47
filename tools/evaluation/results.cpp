// SPDX-License-Identifier: Apache-2.0

#include "results.hpp"

#include <cstdio>
#include <fstream>
#include <iostream>

#include "opencv2/core.hpp"

namespace iib_tools {
namespace {

//! Splits at commas; there are no quotes. A carriage return at the end is dropped.
Fields splitFields(const std::string& line)
{
    Fields fields(1);
    for (char c : line.substr(0, line.find_last_not_of('\r') + 1))
        if (c == ',')
            fields.push_back("");
        else
            fields.back() += c;
    return fields;
}

std::string joinFields(const Fields& fields)
{
    std::string line;
    for (size_t i = 0; i < fields.size(); i++)
        line += (i ? "," : "") + fields[i];
    return line + "\n";
}

}  // namespace

std::vector<Fields> readRows(const std::string& file, const Fields& columns)
{
    std::vector<Fields> rows;
    std::ifstream in(file);
    std::string line;
    if (std::getline(in, line) && splitFields(line) != columns)
        CV_Error(cv::Error::StsParseError,
                file + ": has other columns; move it away or choose another folder");
    while (std::getline(in, line) && !in.eof())  // a complete line ends in a line end
        rows.push_back(splitFields(line));
    for (const Fields& row : rows)
        if (row.size() != columns.size())
            CV_Error(
                    cv::Error::StsParseError, file + ": a row has " + std::to_string(row.size()) + " fields");
    return rows;
}

ResultTable::ResultTable(const std::string& file, const Fields& columns, size_t keys)
    : file_(file), columns_(columns), keys_(keys)
{
    for (const Fields& row : readRows(file, columns))
        rows_[Fields(row.begin(), row.begin() + keys)] = row;
    write();
}

bool ResultTable::has(const Fields& key) const
{
    std::lock_guard<std::mutex> lock(mutex_);
    return rows_.count(key) > 0;
}

void ResultTable::append(const Fields& row)
{
    CV_Assert(row.size() == columns_.size());
    std::lock_guard<std::mutex> lock(mutex_);
    rows_[Fields(row.begin(), row.begin() + keys_)] = row;
    std::ofstream(file_, std::ios::app) << joinFields(row);
}

void ResultTable::finish()
{
    std::lock_guard<std::mutex> lock(mutex_);
    write();
}

void ResultTable::write() const
{
    const std::string draft = file_ + ".new";
    std::ofstream out(draft);
    out << joinFields(columns_);
    for (const auto& row : rows_)
        out << joinFields(row.second);
    out.close();
    if (!out || std::rename(draft.c_str(), file_.c_str()) != 0)
        CV_Error(cv::Error::StsError, file_ + ": cannot be written");
}

Fields withCounts(const Fields& key, const Counts& counts)
{
    return with(
            key, counts.correct, counts.putative, counts.correspondences, precision(counts), recall(counts));
}

std::string text(double value) { return cv::format("%.6g", value); }

int runTasks(const std::string& title, const std::vector<Task>& tasks)
{
    std::mutex mutex;  // of the counts and of stderr
    int failures = 0;
    size_t done = 0;
    const auto body = [&](const cv::Range& range) {
        for (int i = range.start; i < range.end; i++)
        {
            std::string failure;
            try
            {
                tasks[i].run();
            }
            catch (const cv::Exception& e)
            {
                failure = e.err;
            }
            const std::lock_guard<std::mutex> lock(mutex);
            if (!failure.empty())
            {
                failures++;
                std::cerr << "skipped " << tasks[i].name << ": " << failure << std::endl;
            }
            done++;
            if (done * 10 / tasks.size() > (done - 1) * 10 / tasks.size())  // every tenth
                std::cerr << title << ": " << done << "/" << tasks.size() << ", " << tasks[i].name
                          << std::endl;
        }
    };
    cv::parallel_for_(cv::Range(0, int(tasks.size())), body, double(tasks.size()));
    return failures;
}

}  // namespace iib_tools
