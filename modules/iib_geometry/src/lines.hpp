// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "map.hpp"
#include "pose.hpp"

namespace iib_localization {

//! A straight edge in pixels of an image, as seen; the brighter side is always on the same hand.
struct Segment
{
    cv::Point2d begin, end;
};

struct Segments
{
    std::vector<Segment> places;
    cv::Mat codes;  //!< LBD, a row of 32 bytes each
};

//! @throws cv::Exception if this library was built without OpenCV's module line_descriptor.
void needLines();

//! Segments of 20 pixels or more (LSD), described by LBD. Threads may call it at once.
Segments findSegments(const Picture& picture);

//! Bits in which two codes of segments differ, of 256.
int codeDistance(const cv::Mat& a, int rowA, const cv::Mat& b, int rowB);

//! A line of the map where a pose has it.
class SeenLine
{
public:
    //! What is behind the camera is cut off. @param line in the axes of the pose.
    SeenLine(const MapLine& line, const Lens& lens, const cv::Affine3d& pose);

    /** The two places where line and segment begin and end to overlap, as matches of which only the error across the segment
    counts. None unless the line is seen within `limit` pixels of the segment in its direction, along a third of the shorter. */
    std::vector<Match> matchesWith(const Segment& segment, double limit) const;

private:
    const Lens& lens_;
    const cv::Affine3d back_;
    cv::Point3d ends_[2];              //!< in the camera's axes
    std::vector<cv::Point2d> pixels_;  //!< of the ends; NaN for a line behind the camera
};

/** Triangulates the lines that images of a map see.
@param segments of each image. @param pairs of images to be matched. */
void addLines(
        Map& map, const std::vector<Segments>& segments, const std::vector<std::pair<size_t, size_t>>& pairs);

/** Matches with the lines that some of a map's images see, near where a pose has them.
@param frame of the pose. */
std::vector<Match> lineMatches(const Map& map, const std::vector<size_t>& images, const Segments& segments,
        const Lens& lens, const Frame& frame, const cv::Affine3d& pose, double limit);

}  // namespace iib_localization
