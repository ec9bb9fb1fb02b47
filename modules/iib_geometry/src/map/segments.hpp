// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "picture.hpp"

namespace cv::iib {

//! A straight edge in pixels of an image, directed so that the brighter side is always on the same hand.
struct Segment
{
    Point2d begin, end;
};

struct Segments
{
    std::vector<Segment> places;
    Mat codes;  //!< LBD, one row of 32 bytes a segment
};

/** Finds segments of 20 pixels or more (LSD) and describes them (LBD). Thread-safe.
@throws cv::Exception, even for an empty picture, if this library was built without OpenCV's module line_descriptor. */
Segments findSegments(const Picture& picture);

}  // namespace cv::iib
