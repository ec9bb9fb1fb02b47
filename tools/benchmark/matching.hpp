// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#ifndef OPENCV_IIB_BENCHMARK_MATCHING_HPP
#define OPENCV_IIB_BENCHMARK_MATCHING_HPP

#include <vector>

#include "opencv2/core.hpp"

namespace iib_tools {

//! What it costs to match an image's codes of 170 bytes with those of the same points under other light.
struct Matching
{
    struct Row
    {
        cv::String name;
        int codes;  //!< of each image
        bool crossCheck;
        double milliseconds;  //!< least of all rounds
        double right;         //!< part of the queries that found their own point
    };

    std::vector<Row> rows;

    void print() const;
    //! How much slower the rows of another run were, as write() has written them.
    void printAgainst(const cv::FileNode& others) const;
    void write(cv::FileStorage& fs) const;
};

Matching measureMatching(int rounds);

}  // namespace iib_tools

#endif
