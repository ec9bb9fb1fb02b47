// SPDX-License-Identifier: Apache-2.0
#include "overlay.hpp"

#include <algorithm>
#include <map>

namespace cv::iib {
namespace {

const double EXACT = 1. / 400;  // of a cell, .1 pixels of VGA, by which points of an overlay differ
const double LEAST_EXACT =
        .05;  // of the matches: cameras that stand still have up to .05 in other light, and fewer unlike cells
const double MOST_CHANGED = .15;  // of the deviation of the pixels' values, by which theirs differ
const double LEAST_UNLIKE =
        .4;  // of the cells in which both have points; of a still camera before a crowd .35

}  // namespace

bool isOverlay(const SharedPart& reference, const SharedPart& image)
{
    const double side = Spread::cellOf(reference.area);
    Scalar values, deviation;
    meanStdDev(reference.values, values, deviation);
    int exact = 0;
    for (size_t i = 0; i < image.agreeing.size(); i++)
        exact += norm(image.agreeing[i] - reference.agreeing[i]) < EXACT * side &&
                 std::abs(image.values[i] - reference.values[i]) < MOST_CHANGED * deviation[0];
    if (exact <= LEAST_EXACT * (double)image.agreeing.size())
        return false;
    enum
    {
        REFERENCE = 1,
        IMAGE = 2,
        AGREEING = 4
    };
    std::map<std::pair<int, int>, int> cells;
    const auto mark = [&](const std::vector<Point2f>& points, int as) {
        for (const Point2f& p : points)
            cells[{cvFloor(p.x / side), cvFloor(p.y / side)}] |= as;
    };
    mark(reference.points, REFERENCE);
    mark(image.points, IMAGE);
    mark(image.agreeing, AGREEING);
    int both = 0, unlike = 0;
    for (const auto& cell : cells)
    {
        both += (cell.second & (REFERENCE | IMAGE)) == (REFERENCE | IMAGE);
        unlike += cell.second == (REFERENCE | IMAGE);
    }
    return unlike > LEAST_UNLIKE * both;
}

}  // namespace cv::iib
