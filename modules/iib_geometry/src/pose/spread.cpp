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
        const WorkingPair& pair)
{
    Points agreeing;
    for (size_t i = 0; i < agree.size(); i++)
        if (agree[i])
            agreeing.push_back(Point2f(points.reference.at<Point2d>((int)i)));
    const double spanned = areaOf(agreeing);
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
    area = least > 0 ? spanned / least : 0;

    const Size size = pair.size(0);
    int both = 0;
    for (int row = 0; row < SAMPLES_ACROSS; row++)
        for (int column = 0; column < SAMPLES_ACROSS; column++)
        {
            const Point2d p((column + .5) * size.width / SAMPLES_ACROSS - .5,
                    (row + .5) * size.height / SAMPLES_ACROSS - .5);
            both += pair.shows(0, p) && pair.shows(1, moved(toImage, p));
        }
    whole = spanned * SAMPLES_ACROSS * SAMPLES_ACROSS / (std::max(both, 1) * (double)size.area());
}

}  // namespace cv::iib
