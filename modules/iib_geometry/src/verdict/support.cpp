// SPDX-License-Identifier: Apache-2.0
#include "support.hpp"

#include <set>

namespace cv::iib {
namespace {

const size_t MANY = 250, FEW = 80;  // matches that are tested, if few of them may be right, and if most are
const size_t NEAREST = 10;          // neighbours of a match, in the first image
const int LEAST_NEIGHBOURS = 2;     // that agree with it
const double LEAST_DISTANCE = 2;    // pixels; the direction to nearer neighbours is uncertain
const double REGION = 64;           // pixels: about the side of a described region
const size_t FEW_REGIONS = 6;
const double ROUGH = .5;      // tolerance of matches far apart, between which depth and perspective change
const double LEAST_FAR = .3;  // of pairs of matches far apart that agree
const double EXACT = .25;     // tolerance around an estimated map

//! An evenly spaced sample.
Points someOf(const Points& points, size_t most)
{
    const size_t step = (points.size() + most - 1) / most;
    Points some;
    for (size_t i = 0; i < points.size(); i += step)
        some.push_back(points[i]);
    return some;
}

//! Pairs of a point and one of its nearest neighbours, as indices.
typedef std::vector<std::pair<size_t, size_t>> Neighbours;

Neighbours neighboursOf(const Points& points)
{
    Neighbours neighbours;
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
        const size_t nearest = std::min(distances.size(), NEAREST);
        std::nth_element(distances.begin(), distances.begin() + nearest, distances.end());
        for (size_t k = 0; k < nearest; k++)
            neighbours.emplace_back(i, distances[k].second);
    }
    return neighbours;
}

//! Whether displacements lie along one line.
bool isFlat(const Matx22d& moments)
{
    return !(determinant(moments) > 1e-3 * trace(moments) * trace(moments));
}

//! The linear map with the least sum of relative distances of neighbours' displacements, by reweighted least squares.
Matx33d linearOf(const Points& points1, const Points& points2, const Neighbours& neighbours)
{
    const int rounds = 5;
    const double least = .05;  // relative distance: smaller ones have the same weight
    Matx22d linear = Matx22d::eye();
    for (int round = 0; round < rounds; round++)
    {
        Matx22d moments, products;
        for (const auto& [i, j] : neighbours)
        {
            const Vec2d way = points1[j] - points1[i], moved = points2[j] - points2[i];
            const double length2 = way.dot(way),
                         distance =
                                 round ? std::max(norm(moved - linear * way) / std::sqrt(length2), least) : 1;
            moments += way * way.t() * (1 / (length2 * distance));
            products += moved * way.t() * (1 / (length2 * distance));
        }
        if (isFlat(moments))
            break;
        linear = products * moments.inv();
    }
    return {linear(0, 0), linear(0, 1), 0, linear(1, 0), linear(1, 1), 0, 0, 0, 1};
}

Support supportOf(const Points& points1, const Points& points2, const Neighbours& neighbours,
        const Matx33d& roughly, double tolerance)
{
    const Matx22d linear = roughly.get_minor<2, 2>(0, 0);
    std::vector<int> agreeing(points1.size());
    Matx22d moments, products;
    for (const auto& [i, j] : neighbours)
    {
        const Vec2d way = points1[j] - points1[i], moved = points2[j] - points2[i], expected = linear * way;
        if (norm(moved - expected, NORM_L2SQR) > tolerance * tolerance * norm(expected, NORM_L2SQR))
            continue;
        agreeing[i]++;
        const double weight = 1 / way.dot(way);
        moments += weight * way * way.t();
        products += weight * moved * way.t();
    }
    const Matx22d found = isFlat(moments) ? linear : products * moments.inv();
    Support support;
    support.compared = (int)points1.size();
    std::vector<double> shifts[2];
    for (size_t i = 0; i < points1.size(); i++)
    {
        if (agreeing[i] < LEAST_NEIGHBOURS)
            continue;
        support.count++;
        const Vec2d shift = Vec2d(points2[i]) - found * Vec2d(points1[i]);
        shifts[0].push_back(shift[0]);
        shifts[1].push_back(shift[1]);
    }
    support.map = Matx33d(found(0, 0), found(0, 1), median(shifts[0]), found(1, 0), found(1, 1),
            median(shifts[1]), 0, 0, 1);
    return support;
}

}  // namespace

Support Support::around(const Points& all1, const Points& all2, const Matx33d& roughly, double tolerance)
{
    const Points points1 = someOf(all1, MANY), points2 = someOf(all2, MANY);
    const Neighbours neighbours = neighboursOf(points1);
    const Support support = supportOf(points1, points2, neighbours, roughly, tolerance);
    return supportOf(points1, points2, neighbours, support.map, EXACT);
}

Support Support::of(const Points& all1, const Points& all2)
{
    const Points points1 = someOf(all1, FEW), points2 = someOf(all2, FEW);
    const Neighbours neighbours = neighboursOf(points1);
    return supportOf(points1, points2, neighbours, linearOf(points1, points2, neighbours), EXACT);
}

bool agreeFarApart(const Points& all1, const Points& all2, const Matx33d& map)
{
    const Points points1 = someOf(all1, FEW), points2 = someOf(all2, FEW);
    const Matx22d linear = map.get_minor<2, 2>(0, 0);
    const double tolerance2 = ROUGH * ROUGH * std::abs(determinant(linear));
    int far = 0, agreeing = 0;
    for (size_t i = 0; i < points1.size(); i++)
        for (size_t j = 0; j < i; j++)
        {
            const Vec2d way = points1[j] - points1[i], moved = points2[j] - points2[i],
                        expected = linear * way;
            if (way.dot(way) < REGION * REGION)
                continue;
            far++;
            agreeing += norm(moved - expected, NORM_L2SQR) < tolerance2 * way.dot(way);
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
