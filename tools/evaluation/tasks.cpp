// SPDX-License-Identifier: Apache-2.0

#include "tasks.hpp"

#include <iostream>
#include <mutex>

#include "opencv2/core.hpp"

namespace iib_tools {

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
