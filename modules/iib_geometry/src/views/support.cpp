// SPDX-License-Identifier: Apache-2.0
#include "support.hpp"

#include <algorithm>
#include <set>

namespace cv::iib {
namespace {

const size_t MOST_COMPARED = 250;  // matches
const size_t NEIGHBOURS = 10;      // of a match, in the first image
const int LEAST_NEIGHBOURS = 2;    // that agree with it
const double LEAST_DISTANCE = 2;   // pixels; of nearer neighbours the direction is uncertain
const double REGION = 64;          // pixels: about the side of a described region
const size_t FEW_REGIONS = 6;
const double ROUGH = .5;      // tolerance of matches far apart, between which depth and perspective change
const double LEAST_FAR = .3;  // of pairs of matches far apart that agree
const double EXACT = .25;     // tolerance around an estimated map

typedef std::vector<Point2d> Points;

//! Evenly, where there are many.
Points someOf(const Points& points)
{
    const size_t step = (points.size() + MOST_COMPARED - 1) / MOST_COMPARED;
    Points some;
    for (size_t i = 0; i < points.size(); i += step)
        some.push_back(points[i]);
    return some;
}

//! Calls with a match and each of its nearest neighbours.
template <typename Action> void forNeighbours(const Points& points, Action action)
{
    std::vector<std::pair<double, size_t>> distances;
    for (size_t i = 0; i < points.size(); i++)
    {
        distances.clear();
        for (size_t j = 0; j < points.size(); j++)
        {
            const Point2d way = points[j] - points[i];
            if (way.ddot(way) > LEAST_DISTANCE * LEAST_DISTANCE)
                distances.emplace_back(way.ddot(way), j);
        }
        const size_t nearest = std::min(distances.size(), NEIGHBOURS);
        std::nth_element(distances.begin(), distances.begin() + nearest, distances.end());
        for (size_t k = 0; k < nearest; k++)
            action(i, distances[k].second);
    }
}

double medianOf(std::vector<double>& values)
{
    if (values.empty())
        return 0;
    const auto middle = values.begin() + values.size() / 2;
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

//! The similarity whose two numbers are the medians of those of all neighbours.
Matx33d similarityOf(const Points& points1, const Points& points2)
{
    std::vector<double> along, across;
    forNeighbours(points1, [&](size_t i, size_t j) {
        const Point2d way = points1[j] - points1[i], moved = points2[j] - points2[i];
        along.push_back(way.ddot(moved) / way.ddot(way));
        across.push_back(way.cross(moved) / way.ddot(way));
    });
    const double c = medianOf(along), s = medianOf(across);
    return {c, -s, 0, s, c, 0, 0, 0, 1};
}

}  // namespace

Support::Support(const Points& all1, const Points& all2, const Matx33d& roughly, double tolerance)
    : map(roughly)
{
    const Points points1 = someOf(all1), points2 = someOf(all2);
    compared = (int)points1.size();
    const Matx22d linear = roughly.get_minor<2, 2>(0, 0);
    std::vector<int> agreeing(points1.size());
    Matx22d moments, products;
    forNeighbours(points1, [&](size_t i, size_t j) {
        const Vec2d way = points1[j] - points1[i], moved = points2[j] - points2[i], expected = linear * way;
        if (norm(moved - expected, NORM_L2SQR) > tolerance * tolerance * norm(expected, NORM_L2SQR))
            return;
        agreeing[i]++;
        const double weight = 1 / way.dot(way);
        moments += weight * way * way.t();
        products += weight * moved * way.t();
    });
    Matx22d found = linear;
    if (determinant(moments) > 1e-3 * trace(moments) * trace(moments))
        found = products * moments.inv();
    std::vector<double> shifts[2];
    for (size_t i = 0; i < points1.size(); i++)
    {
        if (agreeing[i] < LEAST_NEIGHBOURS)
            continue;
        count++;
        const Vec2d shift = Vec2d(points2[i]) - found * Vec2d(points1[i]);
        shifts[0].push_back(shift[0]);
        shifts[1].push_back(shift[1]);
    }
    map = Matx33d(found(0, 0), found(0, 1), medianOf(shifts[0]), found(1, 0), found(1, 1),
            medianOf(shifts[1]), 0, 0, 1);
}

Support::Support(const Points& points1, const Points& points2)
{
    const Support similar(points1, points2, similarityOf(someOf(points1), someOf(points2)), 2 * EXACT);
    *this = Support(points1, points2, similar.map, EXACT);
}

bool agreeFarApart(const Points& all1, const Points& all2, const Matx33d& map)
{
    const Points points1 = someOf(all1), points2 = someOf(all2);
    const Matx22d linear = map.get_minor<2, 2>(0, 0);
    int far = 0, agreeing = 0;
    for (size_t i = 0; i < points1.size(); i++)
        for (size_t j = 0; j < i; j++)
        {
            const Vec2d way = points1[j] - points1[i], moved = points2[j] - points2[i],
                        expected = linear * way;
            if (way.dot(way) < REGION * REGION)
                continue;
            far++;
            agreeing += norm(moved - expected, NORM_L2SQR) < ROUGH * ROUGH * norm(expected, NORM_L2SQR);
        }
    return far > 0 && agreeing > LEAST_FAR * far;
}

bool areOneStructure(const Points& points)
{
    std::set<std::pair<int, int>> regions;
    for (const Point2d& p : points)
        regions.insert({cvFloor(p.x / REGION), cvFloor(p.y / REGION)});
    return regions.size() < FEW_REGIONS;
}

}  // namespace cv::iib
