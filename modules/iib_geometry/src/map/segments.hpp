// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "picture.hpp"

namespace cv::iib {

//! A straight edge in pixels of an image, as seen; the brighter side is always on the same hand.
struct Segment
{
    Point2d begin, end;
};

struct Segments
{
    std::vector<Segment> places;
    Mat codes;  //!< LBD, a row of 32 bytes each
};

/** Segments of 20 pixels or more (LSD), described by LBD. Threads may call it at once.
@throws cv::Exception, also for an empty picture, if this library was built without OpenCV's module line_descriptor. */
Segments findSegments(const Picture& picture);

}  // namespace cv::iib
