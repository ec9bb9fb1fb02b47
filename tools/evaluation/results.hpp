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

/** Reads the rows of a CSV file. A missing file has none, and an incomplete last line is left out.
@throws cv::Exception if the file has other columns. */
std::vector<Fields> readRows(const std::string& file, const Fields& columns);

/** A CSV file that grows row by row; the next run continues it. The first `keys` columns name a row. Fields hold no commas or
line ends. Safe to use from several threads. */
class ResultTable
{
public:
    //! Reads the rows of an earlier run. @throws cv::Exception as readRows, or if the file cannot be written.
    ResultTable(const std::string& file, const Fields& columns, size_t keys);

    bool has(const Fields& key) const;
    //! Writes the row at once.
    void append(const Fields& row);
    //! Sorts the rows of the file by key, whatever the order of the work.
    void finish();

private:
    void write() const;

    std::string file_;
    Fields columns_;
    size_t keys_;
    std::map<Fields, Fields> rows_;
    mutable std::mutex mutex_;
};

//! At most six significant digits, the same on every machine.
std::string text(double value);
inline std::string text(int value) { return std::to_string(value); }
inline std::string text(size_t value) { return std::to_string(value); }
inline std::string text(const std::string& value) { return value; }

//! Appends values to fields.
template <class... Values> Fields with(Fields fields, const Values&... values)
{
    fields.insert(fields.end(), {text(values)...});
    return fields;
}

//! Appends correct, putative, correspondences, precision and recall.
Fields withCounts(const Fields& key, const Counts& counts);

//! One piece of work, such as an image pair; it throws if its data are broken.
struct Task
{
    std::string name;
    std::function<void()> run;
};

/** Runs the tasks on cv::getNumThreads() threads and reports progress on stderr, ten times in all. A task that throws is reported and
counted, and the others continue.
@return the number of failed tasks. */
int runTasks(const std::string& title, const std::vector<Task>& tasks);

//! A table `<out>/<name>.csv` and the tasks that write its rows.
class Experiment
{
public:
    Experiment(const std::string& out, const std::string& name, const Fields& columns, size_t keys)
        : table(out + "/" + name + ".csv", columns, keys), name_(name)
    {
    }
    //! Plans a task unless the table has the row that it writes last.
    void plan(const Fields& last, const std::string& name, const std::function<void()>& run)
    {
        if (!table.has(last))
            tasks_.push_back({name, run});
    }
    //! Runs the tasks. @return the number of failed ones.
    int run()
    {
        const int failed = runTasks(name_, tasks_);
        table.finish();
        return failed;
    }

    ResultTable table;

private:
    std::string name_;
    std::vector<Task> tasks_;
};

}  // namespace iib_tools
