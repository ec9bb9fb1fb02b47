// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "results.hpp"

namespace iib_tools {

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
