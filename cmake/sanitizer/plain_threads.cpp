// SPDX-License-Identifier: Apache-2.0

// cv::parallel_for_ on plain threads, for the thread sanitizer. OpenCV's own pool (mostly TBB) is not instrumented, so its
// waits would be invisible.

#include "opencv2/core.hpp"
#include "opencv2/core/parallel/parallel_backend.hpp"

#include <algorithm>
#include <atomic>
#include <thread>
#include <vector>

namespace {

class PlainThreads CV_FINAL : public cv::parallel::ParallelForAPI
{
public:
    void parallel_for(int tasks, FN_parallel_for_body_cb_t body, void* data) CV_OVERRIDE
    {
        std::atomic<int> next(0);
        const auto work = [&](int number) {
            threadNumber() = number;
            for (int task = next++; task < tasks; task = next++)
                body(task, task + 1, data);
        };
        std::vector<std::thread> helpers;
        for (int i = 1; i < std::min(threads.load(), tasks); i++)
            helpers.push_back(std::thread(work, i));
        work(0);
        for (std::thread& helper : helpers)
            helper.join();
    }
    int getThreadNum() const CV_OVERRIDE { return threadNumber(); }
    int getNumThreads() const CV_OVERRIDE { return threads; }
    int setNumThreads(int count) CV_OVERRIDE { return threads.exchange(count > 0 ? count : 4); }
    const char* getName() const CV_OVERRIDE { return "plain threads"; }

private:
    static int& threadNumber()
    {
        static thread_local int number = 0;
        return number;
    }

    std::atomic<int> threads{4};
};

const bool installed = (cv::parallel::setParallelForBackend(std::make_shared<PlainThreads>()), true);

}  // namespace
