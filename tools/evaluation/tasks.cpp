// SPDX-License-Identifier: Apache-2.0

#include "tasks.hpp"

#include <unistd.h>

#include <atomic>
#include <iostream>
#include <mutex>

#include "opencv2/core.hpp"

namespace iib_tools {
namespace {

//! Rewrites one line on a terminal; elsewhere tells every tenth.
class Progress
{
public:
    Progress(const std::string& title, size_t total)
        : title_(title), total_(total), terminal_(isatty(STDERR_FILENO) != 0), start_(cv::getTickCount())
    {
    }

    void done(const std::string& name)
    {
        std::lock_guard<std::mutex> lock(mutex_);
        const bool tenth = (done_ + 1) * 10 / total_ > done_ * 10 / total_;
        done_++;
        const double seconds = double(cv::getTickCount() - start_) / cv::getTickFrequency();
        if (terminal_)
            std::cerr << "\r\033[K";
        if (terminal_ || tenth)
            std::cerr << title_ << ": " << done_ << "/" << total_ << ", "
                      << int(seconds * double(total_ - done_) / double(done_) + 0.5) << " s to go, " << name;
        if (terminal_ ? done_ == total_ : tenth)
            std::cerr << "\n";
        std::cerr.flush();
    }

    void failed(const std::string& name, const std::string& why)
    {
        std::lock_guard<std::mutex> lock(mutex_);
        std::cerr << (terminal_ ? "\r\033[K" : "") << "skipped " << name << ": " << why << std::endl;
    }

private:
    std::string title_;
    size_t total_, done_ = 0;
    bool terminal_;
    int64 start_;
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
            try
            {
                tasks[i].run();
            }
            catch (const cv::Exception& e)
            {
                failures++;
                progress.failed(tasks[i].name, e.err);
            }
            progress.done(tasks[i].name);
        }
    };
    cv::parallel_for_(cv::Range(0, int(tasks.size())), body, double(tasks.size()));
    return failures;
}

}  // namespace iib_tools
