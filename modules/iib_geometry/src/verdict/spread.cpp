// SPDX-License-Identifier: Apache-2.0
#include "spread.hpp"

#include <algorithm>
#include <set>

#include "../precomp.hpp"
#include "opencv2/imgproc.hpp"

namespace cv::iib {
namespace {

const int CELLS_ACROSS = 8;
const int LEAST_PLACE = 15, LEAST_MATCHES = 80;  // cells of a group: logos have fewer, or fewer matches
const double LEAST_SPREAD = .12;                 // of what has points: a logo spans less
const double LEAST_WHOLE = .05;                  // of what both images show, whether it has points or not
/* Of the cells that matches of any points would be in, those that agreeing ones are in. Captions and logos at two ends of a picture
have .2 at most, pairs under other light .41 at least. */
const double LEAST_SCATTER = .33;

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

//! Of square cells of this side.
int largestGroup(const Points& points, double side)
{
    std::set<std::pair<int, int>> cells;
    for (const Point2f& p : points)
        cells.insert({cvFloor(p.x / side), cvFloor(p.y / side)});
    int largest = 0;
    while (!cells.empty())
    {
        std::vector<std::pair<int, int>> group = {cells.extract(cells.begin()).value()};
        for (size_t k = 0; k < group.size(); k++)
            for (int neighbour = 0; neighbour < 9; neighbour++)
            {
                const auto cell =
                        cells.find({group[k].first + neighbour % 3 - 1, group[k].second + neighbour / 3 - 1});
                if (cell != cells.end())
                    group.push_back(cells.extract(cell).value());
            }
        largest = std::max(largest, (int)group.size());
    }
    return largest;
}

double ratio(double part, double whole) { return whole > 0 ? part / whole : 0; }

}  // namespace

Spread::Spread(const SharedPart& reference, const SharedPart& image, int sampleSize)
    : connected(CELLS), area(0), whole(1), scatter(0)
{
    for (const SharedPart* part : {&reference, &image})
    {
        const double both = std::max(part->area, 1.);
        connected = std::min(connected, largestGroup(part->agreeing, cellOf(both)));
        area = std::max(area, ratio(areaOf(part->agreeing), areaOf(part->points)));
        whole = std::min(whole, areaWithout(sampleSize, part->agreeing) / both);
        scatter = std::max(scatter, scatterOf(part->agreeing, part->points));
    }
}

bool Spread::isPlace(int matches) const { return connected >= LEAST_PLACE && matches >= LEAST_MATCHES; }

bool Spread::isEverywhere() const
{
    return area >= LEAST_SPREAD && whole >= LEAST_WHOLE && scatter >= LEAST_SCATTER;
}

}  // namespace cv::iib
