// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

// OpenCV alone, without this module: threads inside cv::parallel_for_ while another one calls cv::setNumThreads.
// It ends well after 10 seconds, or by a signal.

#include "common/command_line.hpp"

#include <atomic>
#include <chrono>
#include <thread>

static int run(const iib_tools::CommandLine& line)
{
    if (!line.positional().empty())
        CV_Error(cv::Error::StsBadArg, "no argument but options (--help lists them)");
    const int count = line.whole("threads", 1, 1024);
    const std::chrono::seconds time(line.whole("seconds", 1, 3600));
    std::atomic<bool> stop(false);
    std::atomic<int> rounds(0);
    std::vector<std::thread> threads;
    for (int i = 0; i < count; i++)
        threads.emplace_back([&] {
            while (!stop)
            {
                std::vector<int> squares(1000);
                cv::parallel_for_(cv::Range(0, (int)squares.size()), [&](const cv::Range& range) {
                    for (int n = range.start; n < range.end; n++)
                        squares[n] = n * n;
                });
                rounds++;
            }
        });
    const auto end = std::chrono::steady_clock::now() + time;
    for (int n = 0; std::chrono::steady_clock::now() < end; n++)
        cv::setNumThreads(1 + n % 8);
    stop = true;
    for (std::thread& thread : threads)
        thread.join();
    std::printf("%d threads, %d calls of parallel_for_: no crash\n", count, (int)rounds);
    return 0;
}

int main(int argc, char** argv)
{
    return iib_tools::runTool(argc, argv,
            "cv::setNumThreads while other threads are inside cv::parallel_for_, without this module",
            "{threads|16|that call parallel_for_}"
            "{seconds|10|time to run}",
            run);
}
