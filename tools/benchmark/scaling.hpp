// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#ifndef OPENCV_IIB_BENCHMARK_SCALING_HPP
#define OPENCV_IIB_BENCHMARK_SCALING_HPP

#include "opencv2/core.hpp"

namespace iib_tools {

//! How the default descriptor's time and memory grow, one thread.
struct Scaling
{
    struct Point
    {
        double megapixels;
        int keypoints;
        double milliseconds, orbMilliseconds;  //!< least of all rounds, and cv::ORB's on the same keypoints
    };

    std::vector<Point> pixels;     //!< 1000 keypoints on ever larger images
    std::vector<Point> keypoints;  //!< ever more keypoints on one image
    Point crop, around;            //!< the same 20 keypoints on a crop and on the whole large image
    double bytesPerPixel;  //!< peak of memory beyond image and descriptors, all pixels touched; 0 if unknown

    void print() const;
    void write(cv::FileStorage& fs) const;
};

Scaling measureScaling(int rounds);

}  // namespace iib_tools

#endif
