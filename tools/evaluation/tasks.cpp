// SPDX-License-Identifier: Apache-2.0

#include "tasks.hpp"

#include <atomic>
#include <iostream>
#include <mutex>

#include "opencv2/core.hpp"

namespace iib_tools {
namespace {

//! Tells every tenth of the tasks, and failures.
class Progress
{
public:
    Progress(const std::string& title, size_t total) : title_(title), total_(total) {}

    void done(const std::string& name, const std::string& failure)
    {
        std::lock_guard<std::mutex> lock(mutex_);
        if (!failure.empty())
            std::cerr << "skipped " << name << ": " << failure << std::endl;
        done_++;
        if (done_ * 10 / total_ > (done_ - 1) * 10 / total_)
            std::cerr << title_ << ": " << done_ << "/" << total_ << ", " << name << std::endl;
    }

private:
    std::string title_;
    size_t total_, done_ = 0;
    std::mutex mutex_;
};

}  // namespace

int runTasks(const std::string& title, const std::vector<Task>& tasks)
{
    Progress progress(title, tasks.size());
    std::atomic<int> failures(0);
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
                failures++;
                failure = e.err;
            }
            progress.done(tasks[i].name, failure);
        }
    };
    cv::parallel_for_(cv::Range(0, int(tasks.size())), body, double(tasks.size()));
    return failures;
}

}  // namespace iib_tools
