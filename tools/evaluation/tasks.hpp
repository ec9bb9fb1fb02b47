// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#ifndef IIB_TOOLS_TASKS_HPP
#define IIB_TOOLS_TASKS_HPP

#include <functional>
#include <string>
#include <vector>

namespace iib_tools {

//! One piece of work, such as an image pair; it throws if its data are broken.
struct Task
{
    std::string name;
    std::function<void()> run;
};

/** Runs the tasks on cv::getNumThreads() threads, one line of progress on stderr. A task that throws is told
in one line and counted, and the others go on.
@return how many failed. */
int runTasks(const std::string& title, const std::vector<Task>& tasks);

}  // namespace iib_tools

#endif
