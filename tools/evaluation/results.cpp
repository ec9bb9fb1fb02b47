// SPDX-License-Identifier: Apache-2.0

#include "results.hpp"

#include <cstdio>
#include <fstream>
#include <iostream>

#include "opencv2/core.hpp"

namespace iib_tools {
namespace {

//! Between its commas, which nothing quotes; a carriage return at its end is no part of them.
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
    while (std::getline(in, line) && !in.eof())  // a whole line ends in a line end
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

Fields withCounts(Fields key, const Counts& counts)
{
    for (const std::string& field : {std::to_string(counts.correct), std::to_string(counts.putative),
                 std::to_string(counts.correspondences), text(precision(counts)), text(recall(counts))})
        key.push_back(field);
    return key;
}

std::string text(double value)
{
    char buffer[32];
    std::snprintf(buffer, sizeof(buffer), "%.6g", value);
    return buffer;
}

int runTasks(const std::string& title, const std::vector<Task>& tasks, ResultTable* table)
{
    std::mutex mutex;  // of what follows, and of what is told
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
    if (table)
        table->finish();
    return failures;
}

}  // namespace iib_tools
