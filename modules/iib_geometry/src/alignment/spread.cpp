// SPDX-License-Identifier: Apache-2.0
#include "spread.hpp"

#include "../precomp.hpp"
#include "opencv2/imgproc.hpp"

namespace cv::iib {
namespace {

const int CELLS_ACROSS = 8;
const int SAMPLES_ACROSS = 32;  // of the reference, at which is asked what both images have

typedef std::vector<Point2f> Points;

double areaOf(const Points& points)
{
    Points hull;
    if (points.size() < 3)
        return 0;
    convexHull(points, hull);
    return contourArea(hull);
}

//! Takes the points at these indices out.
Points taken(Points& points, std::vector<int> indices)
{
    Points out;
    std::sort(indices.begin(), indices.end(), std::greater<int>());
    for (int i : indices)
    {
        out.push_back(points[i]);
        points.erase(points.begin() + i);
    }
    return out;
}

//! The area that points span without the few that stretch it most, one after the other.
double areaWithout(int few, Points points)
{
    Points outer;  // which are on the hull once the few before are out
    std::vector<int> hull;
    for (int layer = 0; layer <= few && !points.empty(); layer++)
    {
        convexHull(points, hull);
        const Points next = taken(points, hull);
        outer.insert(outer.end(), next.begin(), next.end());
    }
    for (; few > 0 && !outer.empty(); few--)
    {
        convexHull(outer, hull);
        const auto areaWithoutOne = [&](int corner) {
            Points others = outer;
            taken(others, {corner});
            return areaOf(others);
        };
        std::vector<double> areas;
        std::transform(hull.begin(), hull.end(), std::back_inserter(areas), areaWithoutOne);
        taken(outer, {hull[size_t(std::min_element(areas.begin(), areas.end()) - areas.begin())]});
    }
    return areaOf(outer);
}

std::vector<int> countsOfCells(const Points& points, const Rect& box)
{
    std::vector<int> counts(CELLS_ACROSS * CELLS_ACROSS);
    const auto cell = [](float place, int length) {
        return std::clamp((int)(place / std::max(length, 1) * CELLS_ACROSS), 0, CELLS_ACROSS - 1);
    };
    for (const Point2f& p : points)
        counts[cell(p.y - box.y, box.height) * CELLS_ACROSS + cell(p.x - box.x, box.width)]++;
    return counts;
}

double scatterOf(const Points& agreeing, const Points& points)
{
    const Rect box = boundingRect(points);
    const std::vector<int> matches = countsOfCells(agreeing, box), of = countsOfCells(points, box);
    double expected = 0;
    for (int count : of)
        expected += 1 - std::pow(1 - (double)count / std::max<size_t>(points.size(), 1), agreeing.size());
    return (double)(matches.size() - std::count(matches.begin(), matches.end(), 0)) / std::max(expected, 1.);
}

}  // namespace

Spread::Spread(const AlignedPoints& points, const Verdict::Marks& agree, const Matx33d& transform,
        const WorkingPair& pair, int sampleSize)
{
    Points agreeing;
    for (size_t i = 0; i < agree.size(); i++)
        if (agree[i])
            agreeing.push_back(Point2f(points.reference.at<Point2d>((int)i)));
    const Matx33d toImage = transform.inv();
    double least = std::numeric_limits<double>::max();
    for (int which = 0; which < 2; which++)
    {
        Points common;  // in the reference
        for (const KeyPoint& keypoint : points.keypoints[which])
        {
            const Point2d here = keypoint.pt, there = moved(which ? transform : toImage, here);
            if (pair.shows(!which, there))
                common.push_back(Point2f(which ? there : here));
        }
        least = std::min(least, areaOf(common));
        scatter = std::max(scatter, scatterOf(agreeing, common));
    }
    area = least > 0 ? areaOf(agreeing) / least : 0;

    const Size size = pair.referenceSize();
    int both = 0;
    for (int row = 0; row < SAMPLES_ACROSS; row++)
        for (int column = 0; column < SAMPLES_ACROSS; column++)
        {
            const Point2d p((column + .5) * size.width / SAMPLES_ACROSS - .5,
                    (row + .5) * size.height / SAMPLES_ACROSS - .5);
            both += pair.shows(0, p) && pair.shows(1, moved(toImage, p));
        }
    whole = areaWithout(sampleSize, agreeing) * SAMPLES_ACROSS * SAMPLES_ACROSS /
            (std::max(both, 1) * (double)size.area());
}

}  // namespace cv::iib
