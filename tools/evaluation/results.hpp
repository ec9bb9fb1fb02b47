// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <map>
#include <mutex>
#include <string>
#include <vector>

#include "common/metrics.hpp"

namespace iib_tools {

typedef std::vector<std::string> Fields;

/** The rows of a CSV file; none if there is no such file, and a last line cut short by an interruption is left out.
@throws cv::Exception if the file has other columns. */
std::vector<Fields> readRows(const std::string& file, const Fields& columns);

/** A CSV file that grows row by row and is found again by the next run. The first `keys` columns name a row.
Fields hold no commas or line ends. Safe to use from several threads. */
class ResultTable
{
public:
    //! Goes on with what an earlier run left. @throws cv::Exception as readRows, or if it cannot be written.
    ResultTable(const std::string& file, const Fields& columns, size_t keys);

    bool has(const Fields& key) const;
    //! Writes the row to the file at once.
    void append(const Fields& row);
    //! Rewrites the file in the order of the keys, so that it does not depend on the order of the work.
    void finish();

private:
    void write() const;

    std::string file_;
    Fields columns_;
    size_t keys_;
    std::map<Fields, Fields> rows_;
    mutable std::mutex mutex_;
};

//! The row `key` with correct, putative, correspondences, precision and recall behind it.
Fields withCounts(Fields key, const Counts& counts);

//! A number with at most six significant digits, the same on every machine.
std::string text(double value);

//! One piece of work, such as an image pair; it throws if its data are broken.
struct Task
{
    std::string name;
    std::function<void()> run;
};

/** Runs the tasks on cv::getNumThreads() threads, told on stderr by tenths, and finishes the table that they fill. A task that
throws is told in one line and counted, and the others go on.
@return how many failed. */
int runTasks(const std::string& title, const std::vector<Task>& tasks, ResultTable* table = nullptr);

}  // namespace iib_tools
