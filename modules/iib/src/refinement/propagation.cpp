// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#include "match_refiner.hpp"

namespace cv { namespace iib {

namespace {

const double REACH = 100;  //!< pixels of the first image within which a match predicts others
const double TOLERANCE = 3, TOLERANCE_BY_DISTANCE = .1;  //!< pixels from the predicted place to a keypoint
const size_t CANDIDATES = 4;                             //!< keypoints nearest to the predicted place
const size_t NEIGHBOURS = 8, LEAST_AGREEING = 2;         //!< of a match that predicts others
const double LEAST_SIMILARITY = .7;  //!< higher than for given matches, whose descriptors agreed as well
const int MOST_TRIES = 4;            //!< of a keypoint, each from another match
const int PART = 64;                 //!< keypoints of a job
const double LEAST_CELL = 3;         //!< pixels
const int MOST_MATCHES = 8, MOST_KEYPOINTS = 64;  //!< points of a cell that a search considers

//! A point by its squared distance and its index.
typedef std::pair<double, int> Near;

//! The nearest points so far, nearest first.
class Nearest
{
public:
    static constexpr size_t MOST = 9;

    //! @param count_ points to keep, up to MOST. @param radius that they are within.
    Nearest(size_t count_, double radius) : count(count_), found(0), limit(radius * radius) {}

    //! The squared distance below which a further point is kept.
    double squaredLimit() const { return limit; }
    void add(const Near& point)
    {
        if (!(point.first < limit))
            return;
        size_t place = found < count ? found++ : count - 1;
        for (; place > 0 && points[place - 1] > point; place--)
            points[place] = points[place - 1];
        points[place] = point;
        if (found == count)
            limit = points[count - 1].first;
    }
    const Near* begin() const { return points; }
    const Near* end() const { return points + found; }

private:
    size_t count, found;
    double limit;
    Near points[MOST];
};

//! Points of an image in square cells, about one cell for each point, to find near points in few steps.
class NearPoints
{
public:
    //! @param mostOfCell points of a cell that are kept: the first ones.
    NearPoints(Size image, const std::vector<Vec2d>& all, const std::vector<int>& chosen, int mostOfCell)
        : cell(std::max(std::sqrt((double)image.width * image.height / (chosen.size() + 1)), LEAST_CELL)),
          size(cvCeil(image.width / cell), cvCeil(image.height / cell)), begins(size.area() + 1)
    {
        for (int index : chosen)
            begins[cellOf(all[index]) + 1]++;
        for (size_t i = 1; i < begins.size(); i++)
            begins[i] = begins[i - 1] + std::min(begins[i], mostOfCell);
        std::vector<int> next(begins.begin(), begins.end() - 1);
        points.resize(begins.back());
        for (int index : chosen)
        {
            const int i = cellOf(all[index]);
            if (next[i] < begins[i + 1])
                points[next[i]++] = {all[index], index};
        }
    }

    //! The nearest points, up to `count`, that are nearer than a radius.
    Nearest find(const Vec2d& place, double radius, size_t count) const
    {
        Nearest nearest(count, radius);
        const Point centre(column(place[0]), row(place[1]));
        for (int ring = 0; ring <= std::max(size.width, size.height); ring++)
        {
            const double least = std::max(ring - 1, 0) * cell;  // distance of the ring's points, at least
            if (least * least >= nearest.squaredLimit())
                break;
            const int left = centre.x - ring, right = centre.x + ring;
            for (int y = std::max(centre.y - ring, 0); y <= std::min(centre.y + ring, size.height - 1); y++)
                if (std::abs(y - centre.y) == ring)
                    addCells(place, y, std::max(left, 0), std::min(right, size.width - 1), nearest);
                else
                {
                    if (left >= 0)
                        addCells(place, y, left, left, nearest);
                    if (right < size.width)
                        addCells(place, y, right, right, nearest);
                }
        }
        return nearest;
    }

private:
    struct Place
    {
        Vec2d point;
        int index;
    };

    //! Adds the points of neighbouring cells in a row.
    void addCells(const Vec2d& place, int y, int left, int right, Nearest& nearest) const
    {
        const int* const row = &begins[y * size.width];
        for (int i = row[left]; i < row[right + 1]; i++)
        {
            const Vec2d offset = points[i].point - place;
            nearest.add(Near(offset.dot(offset), points[i].index));
        }
    }

    //! Places outside the image belong to the outermost cells.
    static int limited(double place, int end) { return (int)std::min(std::max(place, 0.), end - 1.); }
    int column(double x) const { return limited(x / cell, size.width); }
    int row(double y) const { return limited(y / cell, size.height); }
    int cellOf(const Vec2d& point) const { return row(point[1]) * size.width + column(point[0]); }

    double cell;
    Size size;
    std::vector<int> begins;  //!< of each cell's points
    std::vector<Place> points;
};

std::vector<Vec2d> placesOf(const std::vector<KeyPoint>& keypoints)
{
    std::vector<Vec2d> places;
    for (const KeyPoint& keypoint : keypoints)
        places.push_back(Vec2d(keypoint.pt.x, keypoint.pt.y));
    return places;
}

template <class Marked> std::vector<int> unmarked(size_t end, const Marked& isMarked)
{
    std::vector<int> indices;
    for (size_t i = 0; i < end; i++)
        if (!isMarked(i))
            indices.push_back((int)i);
    return indices;
}

//! A refined match: a point of the first image, its place in the second one, and the warp of the surroundings.
struct Seed
{
    Vec2d first, second;
    Matx22d warp;

    Vec2d predict(const Vec2d& point) const { return second + warp * (point - first); }
    double tolerance(const Vec2d& point) const
    {
        return TOLERANCE + TOLERANCE_BY_DISTANCE * norm(point - first);
    }
};

//! Whether at least LEAST_AGREEING of the nearest seeds predict it.
bool isTrusted(int seed, const std::vector<Seed>& seeds, const NearPoints& ofSeeds)
{
    static_assert(NEIGHBOURS < Nearest::MOST && CANDIDATES <= Nearest::MOST, "there is room");
    const Seed& s = seeds[seed];
    size_t agreeing = 0;
    for (const Near& near : ofSeeds.find(s.first, REACH, NEIGHBOURS + 1))
    {
        const Seed& other = seeds[near.second];
        agreeing += near.second != seed && norm(other.predict(s.first) - s.second) < other.tolerance(s.first);
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
    for (size_t done = 0; done < matches.size();)
    {
        const size_t before = seeds.size();
        for (; done < matches.size(); done++)
        {
            const Refinement& r = matches[done];
            if (!r.found.accepted)
                continue;
            seeds.push_back({places1[r.match.queryIdx], r.found.point, r.found.warp});
            seedPlaces.push_back(seeds.back().first);
        }
        const NearPoints ofSeeds(refiner.firstSize(), seedPlaces,
                unmarked(seeds.size(), [](size_t) { return false; }), MOST_MATCHES);
        const std::vector<int> trusted = unmarked(
                seeds.size(), [&](size_t i) { return i < before || !isTrusted((int)i, seeds, ofSeeds); });
        // trusted seeds of this round
        const NearPoints ofTrusted(refiner.firstSize(), seedPlaces, trusted, MOST_MATCHES);
        const NearPoints ofSecond(refiner.secondSize(), places2,
                unmarked(places2.size(), [&](size_t t) { return matched2[t] || !refiner.containsSecond(t); }),
                MOST_KEYPOINTS);

        const int parts = ((int)keypoints1.size() + PART - 1) / PART;
        std::vector<std::vector<Refinement>> ofParts(parts);
        const auto listTries = [&](int part) {
            for (int q = part * PART; q < std::min((part + 1) * PART, (int)keypoints1.size()); q++)
            {
                if (matched1[q] || triesOf[q] == MOST_TRIES || !refiner.containsFirst(q))
                    continue;
                const Nearest trust = ofTrusted.find(places1[q], REACH, 1);
                if (trust.begin() == trust.end())
                    continue;
                triesOf[q]++;
                const Seed& seed = seeds[trust.begin()->second];
                for (const Near& t :
                        ofSecond.find(seed.predict(places1[q]), seed.tolerance(places1[q]), CANDIDATES))
                    if (refiner.mayMatch(q, t.second, seed.warp))
                        ofParts[part].emplace_back(
                                DMatch(q, t.second, std::numeric_limits<float>::max()), seed.warp);
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

}}  // namespace cv::iib
