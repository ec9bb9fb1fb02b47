// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>

#include "opencv2/core/utility.hpp"

namespace cv::iib {

//! Calls an action with each index, in parallel. An exception ends the loop and is rethrown.
template <typename Action> void inParallel(size_t count, Action action)
{
    std::atomic<bool> ended(false);
    parallel_for_(Range(0, int(count)), [&](const Range& range) {
        for (int i = range.start; i < range.end && !ended; i++)
        {
            try
            {
                action(size_t(i));
            }
            catch (...)
            {
                ended = true;
                throw;
            }
        }
    });
}

}  // namespace cv::iib
