// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <unistd.h>

#include <chrono>
#include <iostream>
#include <mutex>
#include <string>

namespace iib_localization {

//! Counts steps on standard error: rewritten in place on a terminal, a line each 30 seconds elsewhere.
class Progress
{
public:
    Progress(const std::string& title, size_t total) : title_(title), total_(total) {}
    ~Progress()
    {
        if (live_)
            std::cerr << "\n";
    }

    void step()
    {
        const std::lock_guard<std::mutex> lock(mutex_);
        const auto now = std::chrono::steady_clock::now();
        done_++;
        if (now - shown_ < std::chrono::milliseconds(live_ ? 200 : 30000) && !(live_ && done_ == total_))
            return;
        shown_ = now;
        std::cerr << (live_ ? "\r" : "") << title_ << " " << done_ << "/" << total_ << (live_ ? "   " : "\n")
                  << std::flush;
    }

private:
    const std::string title_;
    const size_t total_;
    size_t done_ = 0;
    const bool live_ = isatty(STDERR_FILENO) != 0;
    std::chrono::steady_clock::time_point shown_ = std::chrono::steady_clock::now();
    std::mutex mutex_;
};

}  // namespace iib_localization
