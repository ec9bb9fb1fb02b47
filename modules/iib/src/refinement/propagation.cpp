// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#include "match_refiner.hpp"

#include <map>

namespace cv {
namespace iib {

namespace {

const double REACH = 100;  //!< pixels of the first image across which a match predicts others
const double TOLERANCE = 3, TOLERANCE_BY_DISTANCE = .1;  //!< pixels between where a point is predicted and is
const size_t CANDIDATES = 4;  //!< keypoints of the second image, the nearest to where one should be
const size_t NEIGHBOURS = 8, LEAST_AGREEING = 2;  //!< of a match that predicts others
const double LEAST_SIMILARITY = .7;  //!< higher than of given matches, whose descriptors agreed as well

//! Finds points of a plane near a place.
class NearPoints
{
public:
    //! @param reach the largest radius asked for.
    explicit NearPoints(double reach) : cell(reach) {}

    void add(const Vec2d& point, int index) { cells[cellOf(point)].push_back({point, index}); }

    //! Indices of up to `most` points nearer than a radius, the nearest first.
    std::vector<int> find(const Vec2d& place, double radius, size_t most) const
    {
        std::vector<std::pair<double, int>> near;
        const Cell centre = cellOf(place);
        for (int y = -1; y <= 1; y++)
            for (int x = -1; x <= 1; x++)
            {
                const auto found = cells.find({centre.first + y, centre.second + x});
                if (found == cells.end())
                    continue;
                for (const std::pair<Vec2d, int>& point : found->second)
                {
                    const Vec2d beside = point.first - place;
                    if (beside.dot(beside) < radius * radius)
                        near.push_back({beside.dot(beside), point.second});
                }
            }
        most = std::min(near.size(), most);
        std::partial_sort(near.begin(), near.begin() + most, near.end());
        near.resize(most);
        std::vector<int> indices;
        for (const std::pair<double, int>& point : near)
            indices.push_back(point.second);
        return indices;
    }

private:
    typedef std::pair<int, int> Cell;

    Cell cellOf(const Vec2d& point) const { return {cvFloor(point[1] / cell), cvFloor(point[0] / cell)}; }

    double cell;
    std::map<Cell, std::vector<std::pair<Vec2d, int>>> cells;
};

Vec2d placeOf(const KeyPoint& keypoint) { return Vec2d(keypoint.pt.x, keypoint.pt.y); }

//! A refined match: where a point of the first image is in the second one, and the surroundings with it.
struct Seed
{
    Vec2d first, second;
    Matx22d map;

    Vec2d predict(const Vec2d& point) const { return second + map * (point - first); }
    double tolerance(const Vec2d& point) const
    {
        return TOLERANCE + TOLERANCE_BY_DISTANCE * norm(point - first);
    }
};

//! Whether others near it predict it.
bool isTrusted(int seed, const std::vector<Seed>& seeds, const NearPoints& ofSeeds)
{
    const Seed& s = seeds[seed];
    size_t agreeing = 0;
    for (int k : ofSeeds.find(s.first, REACH, NEIGHBOURS + 1))
        agreeing += k != seed && norm(seeds[k].predict(s.first) - s.second) < seeds[k].tolerance(s.first);
    return agreeing >= LEAST_AGREEING;
}

}  // namespace

void propagate(const MatchRefiner& refiner, const std::vector<KeyPoint>& keypoints1,
        const std::vector<KeyPoint>& keypoints2, std::vector<Refinement>& matches)
{
    std::vector<bool> matched1(keypoints1.size()), matched2(keypoints2.size());
    for (const Refinement& r : matches)
        matched1[r.match.queryIdx] = matched2[r.match.trainIdx] = true;
    NearPoints ofSecond(TOLERANCE + TOLERANCE_BY_DISTANCE * REACH), ofSeeds(REACH);
    for (size_t t = 0; t < keypoints2.size(); t++)
        if (refiner.seesSecond(t))
            ofSecond.add(placeOf(keypoints2[t]), (int)t);

    std::vector<Seed> seeds;
    for (size_t done = 0; done < matches.size();)
    {
        const size_t before = seeds.size();
        for (; done < matches.size(); done++)
        {
            const Refinement& r = matches[done];
            if (!r.found.accepted)
                continue;
            seeds.push_back({placeOf(keypoints1[r.match.queryIdx]), r.found.point, r.found.map});
            ofSeeds.add(seeds.back().first, (int)seeds.size() - 1);
        }
        NearPoints ofTrusted(REACH);  // of the last round
        for (size_t i = before; i < seeds.size(); i++)
            if (isTrusted((int)i, seeds, ofSeeds))
                ofTrusted.add(seeds[i].first, (int)i);

        std::vector<Refinement> tried;
        for (size_t q = 0; q < keypoints1.size(); q++)
        {
            if (matched1[q] || !refiner.seesFirst(q))
                continue;
            const Vec2d point = placeOf(keypoints1[q]);
            for (int k : ofTrusted.find(point, REACH, 1))
            {
                const Seed& seed = seeds[k];
                for (int t : ofSecond.find(seed.predict(point), seed.tolerance(point), CANDIDATES))
                    if (!matched2[t])
                        tried.emplace_back(DMatch((int)q, t, std::numeric_limits<float>::max()), seed.map);
            }
        }
        refiner.refine(tried);
        std::stable_sort(tried.begin(), tried.end(), [](const Refinement& a, const Refinement& b) {
            return a.found.similarity > b.found.similarity;
        });
        for (const Refinement& r : tried)
            if (r.found.similarity > LEAST_SIMILARITY && !matched1[r.match.queryIdx] &&
                    !matched2[r.match.trainIdx])
            {
                matched1[r.match.queryIdx] = matched2[r.match.trainIdx] = true;
                matches.push_back(r);
            }
    }
}

}  // namespace iib
}  // namespace cv
