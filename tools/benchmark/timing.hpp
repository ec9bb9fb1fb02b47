// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#ifndef OPENCV_IIB_BENCHMARK_TIMING_HPP
#define OPENCV_IIB_BENCHMARK_TIMING_HPP

#include "opencv2/core/utility.hpp"

#include <functional>

namespace iib_tools {

//! Milliseconds that one call takes.
inline double timeOf(const std::function<void()>& work)
{
    cv::TickMeter meter;
    meter.start();
    work();
    meter.stop();
    return meter.getTimeMilli();
}

}  // namespace iib_tools

#endif
