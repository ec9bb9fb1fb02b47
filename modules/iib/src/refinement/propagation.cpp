// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#include "match_refiner.hpp"

namespace cv {
namespace iib {

namespace {

const double REACH = 100;  //!< pixels of the first image across which a match predicts others
const double TOLERANCE = 3, TOLERANCE_BY_DISTANCE = .1;  //!< pixels between where a point is predicted and is
const size_t CANDIDATES = 4;  //!< keypoints of the second image, the nearest to where one should be
const size_t NEIGHBOURS = 8, LEAST_AGREEING = 2;  //!< of a match that predicts others
const double LEAST_SIMILARITY = .7;  //!< higher than of given matches, whose descriptors agreed as well
const int MOST_TRIES = 4;            //!< of a keypoint, each from another match
const int PART = 64;                 //!< keypoints that a thread looks at

const double LEAST_CELL = 3;  //!< pixels

//! Points of an image in square cells, about as many as points, so that those near a place are found in few steps.
class NearPoints
{
public:
    //! @param mostOfCell of the points of a cell that are looked at: the first ones.
    NearPoints(Size image, const std::vector<Vec2d>& points, const std::vector<int>& chosen, int mostOfCell)
        : all(points), most(mostOfCell),
          cell(std::max(std::sqrt((double)image.width * image.height / (chosen.size() + 1)), LEAST_CELL)),
          size(cvCeil(image.width / cell), cvCeil(image.height / cell)), begins(size.area() + 1)
    {
        for (int index : chosen)
            begins[cellOf(points[index]) + 1]++;
        for (size_t i = 1; i < begins.size(); i++)
            begins[i] += begins[i - 1];
        std::vector<int> next(begins.begin(), begins.end() - 1);
        indices.resize(chosen.size());
        for (int index : chosen)
            indices[next[cellOf(points[index])]++] = index;
    }

    //! Finds up to `count` points nearer than a radius, the nearest first. @param found squared distances and indices.
    void find(
            const Vec2d& place, double radius, size_t count, std::vector<std::pair<double, int>>& found) const
    {
        found.clear();
        double limit = radius * radius;
        const Point centre(column(place[0]), row(place[1]));
        for (int ring = 0; ring <= std::max(size.width, size.height); ring++)
        {
            const double least = std::max(ring - 1, 0) * cell;  // nothing of the ring is nearer
            if (least * least >= limit)
                break;
            for (int y = std::max(centre.y - ring, 0); y <= std::min(centre.y + ring, size.height - 1); y++)
            {
                const bool edge = std::abs(y - centre.y) == ring;
                for (int x = centre.x - ring; x <= centre.x + ring; x += edge ? 1 : std::max(2 * ring, 1))
                    if (x >= 0 && x < size.width)
                        limit = addNearer(place, y * size.width + x, limit, count, found);
            }
        }
    }

private:
    double addNearer(const Vec2d& place, int i, double limit, size_t count,
            std::vector<std::pair<double, int>>& found) const
    {
        for (int k = begins[i]; k < std::min(begins[i + 1], begins[i] + most); k++)
        {
            const Vec2d beside = all[indices[k]] - place;
            const std::pair<double, int> point(beside.dot(beside), indices[k]);
            if (!(point.first < limit))
                continue;
            found.insert(std::upper_bound(found.begin(), found.end(), point), point);
            if (found.size() > count)
                found.pop_back();
            if (found.size() == count)
                limit = found.back().first;
        }
        return limit;
    }

    //! Places outside of the image are nearest to its edge.
    static int limited(double place, int end) { return (int)std::min(std::max(place, 0.), end - 1.); }
    int column(double x) const { return limited(x / cell, size.width); }
    int row(double y) const { return limited(y / cell, size.height); }
    int cellOf(const Vec2d& point) const { return row(point[1]) * size.width + column(point[0]); }

    const std::vector<Vec2d>& all;
    int most;
    double cell;
    Size size;
    std::vector<int> begins, indices;  //!< of the points of each cell
};

const int MOST_MATCHES = 8, MOST_KEYPOINTS = 64;  //!< of a cell that are looked at

std::vector<Vec2d> placesOf(const std::vector<KeyPoint>& keypoints)
{
    std::vector<Vec2d> places;
    for (const KeyPoint& keypoint : keypoints)
        places.push_back(Vec2d(keypoint.pt.x, keypoint.pt.y));
    return places;
}

//! The indices below `end` that are not marked.
template <class Marked> std::vector<int> unmarked(size_t end, const Marked& isMarked)
{
    std::vector<int> indices;
    for (size_t i = 0; i < end; i++)
        if (!isMarked(i))
            indices.push_back((int)i);
    return indices;
}

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

//! Whether others near it predict it. @param near room for these.
bool isTrusted(int seed, const std::vector<Seed>& seeds, const NearPoints& ofSeeds,
        std::vector<std::pair<double, int>>& near)
{
    const Seed& s = seeds[seed];
    ofSeeds.find(s.first, REACH, NEIGHBOURS + 1, near);
    size_t agreeing = 0;
    for (const std::pair<double, int>& k : near)
    {
        const Seed& other = seeds[k.second];
        agreeing += k.second != seed && norm(other.predict(s.first) - s.second) < other.tolerance(s.first);
    }
    return agreeing >= LEAST_AGREEING;
}

}  // namespace

void propagate(const MatchRefiner& refiner, const std::vector<KeyPoint>& keypoints1,
        const std::vector<KeyPoint>& keypoints2, std::vector<Refinement>& matches)
{
    std::vector<bool> matched1(keypoints1.size()), matched2(keypoints2.size());
    for (const Refinement& r : matches)
        matched1[r.match.queryIdx] = matched2[r.match.trainIdx] = true;
    const std::vector<Vec2d> places1 = placesOf(keypoints1), places2 = placesOf(keypoints2);
    std::vector<int> triesOf(keypoints1.size());
    std::vector<Seed> seeds;
    std::vector<Vec2d> seedPlaces;
    std::vector<std::pair<double, int>> near;
    for (size_t done = 0; done < matches.size();)
    {
        const size_t before = seeds.size();
        for (; done < matches.size(); done++)
        {
            const Refinement& r = matches[done];
            if (!r.found.accepted)
                continue;
            seeds.push_back({places1[r.match.queryIdx], r.found.point, r.found.map});
            seedPlaces.push_back(seeds.back().first);
        }
        const NearPoints ofSeeds(refiner.firstSize(), seedPlaces,
                unmarked(seeds.size(), [](size_t) { return false; }), MOST_MATCHES);
        const std::vector<int> trusted = unmarked(seeds.size(),
                [&](size_t i) { return i < before || !isTrusted((int)i, seeds, ofSeeds, near); });
        const NearPoints ofTrusted(
                refiner.firstSize(), seedPlaces, trusted, MOST_MATCHES);  // of the last round
        const NearPoints ofSecond(refiner.secondSize(), places2,
                unmarked(places2.size(), [&](size_t t) { return matched2[t] || !refiner.seesSecond(t); }),
                MOST_KEYPOINTS);

        const int parts = ((int)keypoints1.size() + PART - 1) / PART;
        std::vector<std::vector<Refinement>> ofParts(parts);
        const auto listTries = [&](int part) {
            std::vector<std::pair<double, int>> nearest, candidates;
            for (int q = part * PART; q < std::min((part + 1) * PART, (int)keypoints1.size()); q++)
            {
                if (matched1[q] || triesOf[q] == MOST_TRIES || !refiner.seesFirst(q))
                    continue;
                ofTrusted.find(places1[q], REACH, 1, nearest);
                if (nearest.empty())
                    continue;
                triesOf[q]++;
                const Seed& seed = seeds[nearest[0].second];
                ofSecond.find(seed.predict(places1[q]), seed.tolerance(places1[q]), CANDIDATES, candidates);
                for (const std::pair<double, int>& t : candidates)
                    if (refiner.mayMatch(q, t.second, seed.map))
                        ofParts[part].emplace_back(
                                DMatch(q, t.second, std::numeric_limits<float>::max()), seed.map);
            }
        };
        parallel_for_(Range(0, parts), [&](const Range& range) {
            for (int part = range.start; part < range.end; part++)
                listTries(part);
        });
        std::vector<Refinement> tries;
        for (const std::vector<Refinement>& some : ofParts)
            tries.insert(tries.end(), some.begin(), some.end());
        refiner.refine(tries);
        std::stable_sort(tries.begin(), tries.end(), [](const Refinement& a, const Refinement& b) {
            return a.found.similarity > b.found.similarity;
        });
        for (const Refinement& r : tries)
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
