// SPDX-License-Identifier: Apache-2.0

#include "guided_matches.hpp"

#include <algorithm>
#include <functional>
#include <iterator>
#include <map>

namespace cv::iib {
namespace {

constexpr double LEAST_REFINED = .03;  // pixels: least standard deviation of refined matches
constexpr double MAX_RATIO = 6;        // of a point's sizes in two images

const auto isRefined = std::mem_fn(&Match::isRefined);

}  // namespace

void refineAgainstViews(std::vector<Match>& matches, const Views& views, size_t least)
{
    std::map<int, std::vector<size_t>> byView;
    for (size_t i = 0; i < matches.size(); i++)
        byView[matches[i].view].push_back(i);
    for (const auto& [view, numbers] : byView)
    {
        const MapImage& image = views.map.images[size_t(view)];
        if (numbers.size() < least || image.picture.pixels.empty())
            continue;
        KeypointPairs pairs;
        for (size_t i : numbers)
        {
            const Match& m = matches[i];
            pairs.fixed.emplace_back(image.pixels[size_t(m.row)], m.sizes[0]);
            pairs.moved.emplace_back(m.pixel, m.sizes[1]);
        }
        const std::vector<bool> placed =
                refine(views.pictures.of(size_t(view), image.picture), views.own, pairs);
        for (size_t k = 0; k < numbers.size(); k++)
            if (placed[k])
            {
                matches[numbers[k]].pixel = pairs.moved[k].pt;
                matches[numbers[k]].isRefined = true;
            }
    }
}

std::vector<Match> guidedMatches(const Views& views, const std::vector<size_t>& compared, const Lens& lens,
        const Frame& frame, const Affine3d& pose)
{
    const Rect2d inside(Point2d(), Size2d(views.own.image.pixels.size()) / views.own.scale);
    std::map<int, std::pair<double, Match>> best;  // by point: log ratio of sizes, predicted match
    for (size_t view : compared)
    {
        const MapImage& image = views.map.images[view];
        const double zoom = lens.matrix()(0, 0) / image.camera.parameters[0];
        std::vector<Point3d> points = views.map.seenBy(image);
        const std::vector<Point3d> there = inCamera(points, image.cameraFromWorld);
        for (Point3d& p : points)
            p = frame.toLocal(p);
        const std::vector<Point3d> here = inCamera(points, pose);
        const std::vector<Point2d> places = lens.project(here);
        for (size_t row = 0; row < places.size(); row++)
        {
            const double ratio = std::log(zoom * there[row].z / (here[row].z * frame.unit));
            if (!inside.contains(places[row]) || !(std::abs(ratio) < std::log(MAX_RATIO)))
                continue;
            const int number = image.sees[row];
            const auto known = best.find(number);
            if (known == best.end() || std::abs(ratio) < std::abs(known->second.first))
                best[number] = {ratio, {places[row], points[row], number, -1, 0, int(view), int(row),
                                               Vec2f(1, float(std::exp(ratio)))}};
        }
    }
    std::vector<Match> matches, refined;
    for (size_t view : compared)
        for (const auto& [number, predicted] : best)
            if (predicted.second.view == int(view))
                matches.push_back(predicted.second);
    refineAgainstViews(matches, views, 1);
    std::copy_if(matches.begin(), matches.end(), std::back_inserter(refined), isRefined);
    return refined;
}

void learnDeviation(std::vector<Match>& matches, const Lens& lens, const Affine3d& pose)
{
    std::vector<Match> some;
    std::copy_if(matches.begin(), matches.end(), std::back_inserter(some), isRefined);
    const double deviation = std::max(LEAST_REFINED, deviationOf(errorsOf(some, lens, pose)));
    for (Match& m : matches)
        if (m.isRefined)
            m.deviation = deviation;
}

}  // namespace cv::iib
