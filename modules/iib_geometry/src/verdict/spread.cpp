// SPDX-License-Identifier: Apache-2.0
#include "spread.hpp"

#include <map>
#include <set>

#include "../precomp.hpp"
#include "opencv2/imgproc.hpp"

namespace cv::iib {
namespace {

const int CELLS_ACROSS = 8;
const int LEAST_PLACE = 15, LEAST_MATCHES = 80;  // logos have fewer connected cells, or fewer matches
const double LEAST_AREA = .045;                  // of an image: places have .055, logos at two places .04
const double LEAST_SPREAD = .12;                 // of the keypoints' hull; a logo spans less
const double LEAST_WHOLE = .05;                  // of an image
// Captions and logos at two ends of a picture have .2 at most, pairs under changed illumination .41 at least.
const double LEAST_SCATTER = .33;

const double EXACT = 1. / 400;    // of a cell's side, .1 pixels of VGA: largest distance of equal points
const double LEAST_EXACT = .05;   // of the matches; static cameras have fewer, or fewer unlike cells
const double MOST_CHANGED = .15;  // of the pixel values' deviation: largest difference of equal points
const double LEAST_UNLIKE = .4;  // of the cells with keypoints of both; a still camera before a crowd has .35

typedef std::vector<Point2f> Points;

double areaOf(const Points& points)
{
    Points hull;
    if (points.size() < 3)
        return 0;
    convexHull(points, hull);
    return contourArea(hull);
}

//! Area of the hull without the few points that enlarge it most, removed one by one.
double areaWithout(int few, Points points)
{
    Points outer;  // the hull, and the hulls that removing points uncovers
    std::vector<int> hull;
    for (int layer = 0; layer <= few && !points.empty(); layer++)
    {
        convexHull(points, hull);
        std::sort(hull.begin(), hull.end(), std::greater<int>());
        for (int i : hull)
        {
            outer.push_back(points[i]);
            points.erase(points.begin() + i);
        }
    }
    for (; few > 0 && !outer.empty(); few--)
    {
        convexHull(outer, hull);
        std::vector<double> areas;
        for (int corner : hull)
        {
            Points others = outer;
            others.erase(others.begin() + corner);
            areas.push_back(areaOf(others));
        }
        outer.erase(outer.begin() + hull[std::min_element(areas.begin(), areas.end()) - areas.begin()]);
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

typedef std::pair<int, int> Cell;

double sideOf(double area) { return std::sqrt(std::max(area, 1.) / Spread::CELLS); }

Cell cellOf(const Point2f& p, double side) { return {cvFloor(p.x / side), cvFloor(p.y / side)}; }

//! Number of cells in the largest connected group.
int largestGroup(const Points& points, double side)
{
    std::set<Cell> cells;
    for (const Point2f& p : points)
        cells.insert(cellOf(p, side));
    int largest = 0;
    while (!cells.empty())
    {
        std::vector<Cell> group = {cells.extract(cells.begin()).value()};
        for (size_t k = 0; k < group.size(); k++)
            for (int neighbour = 0; neighbour < 9; neighbour++)
                if (const Cell cell = {group[k].first + neighbour % 3 - 1,
                            group[k].second + neighbour / 3 - 1};
                        cells.erase(cell))
                    group.push_back(cell);
        largest = std::max(largest, (int)group.size());
    }
    return largest;
}

double ratio(double part, double whole) { return whole > 0 ? part / whole : 0; }

}  // namespace

Spread::Spread(const SharedPart& reference, const SharedPart& image, int sampleSize)
{
    const double share = std::max({reference.share, image.share, 1e-3});
    for (const SharedPart* part : {&reference, &image})
    {
        const double shown = std::max(part->area / share, 1.);
        connected = std::min(connected, largestGroup(part->agreeing, sideOf(shown)));
        area = std::max(area, ratio(areaOf(part->agreeing), areaOf(part->points)));
        whole = std::min(whole, areaWithout(sampleSize, part->agreeing) / shown);
        scatter = std::max(scatter, scatterOf(part->agreeing, part->points));
    }
}

bool Spread::isPlace(int matches) const
{
    return connected >= LEAST_PLACE && matches >= LEAST_MATCHES && whole >= LEAST_AREA;
}

bool Spread::isEverywhere() const
{
    return area >= LEAST_SPREAD && whole >= LEAST_WHOLE && scatter >= LEAST_SCATTER;
}

bool isOverlay(const SharedPart& reference, const SharedPart& image)
{
    const double side = sideOf(reference.area);
    Scalar values, deviation;
    meanStdDev(reference.values, values, deviation);
    int exact = 0;
    for (size_t i = 0; i < image.agreeing.size(); i++)
        exact += norm(image.agreeing[i] - reference.agreeing[i]) < EXACT * side &&
                 std::abs(image.values[i] - reference.values[i]) < MOST_CHANGED * deviation[0];
    if (exact <= LEAST_EXACT * (double)image.agreeing.size())
        return false;
    std::map<Cell, int> cells;  // a bit for each list of points
    const Points* const lists[] = {&reference.points, &image.points, &image.agreeing};
    for (int list = 0; list < 3; list++)
        for (const Point2f& p : *lists[list])
            cells[cellOf(p, side)] |= 1 << list;
    int both = 0, unlike = 0;
    for (const auto& cell : cells)
    {
        both += (cell.second & 3) == 3;
        unlike += cell.second == 3;
    }
    return unlike > LEAST_UNLIKE * both;
}

}  // namespace cv::iib
