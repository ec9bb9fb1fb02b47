// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#ifndef OPENCV_IIB_BENCHMARK_FRAMES_HPP
#define OPENCV_IIB_BENCHMARK_FRAMES_HPP

#include "opencv2/core.hpp"

namespace iib_tools {

//! What small work costs, of which a video has much, and what a second thread brings. Milliseconds, least of all rounds.
struct Frames
{
    double orb, iib;     //!< a frame described and matched to the last one, on two threads
    double oneKeypoint;  //!< of such a frame, described
    double oneCode;      //!< matched with one
    double describe[2];  //!< many keypoints, on one thread and on two
    double match[2];     //!< many codes, mutually

    void print() const;
    void write(cv::FileStorage& fs) const;
};

Frames measureFrames(int rounds);

}  // namespace iib_tools

#endif
