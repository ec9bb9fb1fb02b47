// SPDX-License-Identifier: Apache-2.0
#include "../views/view_matches.hpp"
#include "guided_matches.hpp"

namespace cv::iib {
namespace {

const double MOST_TILT = 1;  // tilted views would take three times as long
const int FEATURES = 2000;
const double REACH = .05;  // of the longer side: largest distance of a keypoint from its nearest match

}  // namespace

std::vector<Match> matchesInViews(const Map& map, size_t view, const ImageViews& image)
{
    const MapImage& mapImage = map.images[view];
    const ImageViews picture(mapImage.picture.pixels, Mat(), FEATURES);
    const ViewMatches found = matchInSomeViews(picture, image, MOST_TILT);
    std::vector<Match> matches;
    if (!found.isDecisive())
        return matches;
    const double scale = mapImage.picture.scale;
    const Matx22d linear = found.map.get_minor<2, 2>(0, 0);
    const float zoom = (float)(std::sqrt(std::abs(determinant(linear))) * scale);
    const double reach = REACH * std::max(picture.size().width, picture.size().height);
    const std::vector<Point3d> points = map.seenBy(mapImage);
    for (size_t row = 0; row < points.size(); row++)
    {
        const Point2d pixel = mapImage.pixels[row],
                      place((pixel.x + .5) * scale - .5, (pixel.y + .5) * scale - .5);
        int nearest = -1;
        double least = reach;
        for (int i = 0; i < found.points1.rows; i++)
        {
            const double distance = norm(Point2d(found.points1.at<Point2f>(i)) - place);
            if (distance < least)
            {
                least = distance;
                nearest = i;
            }
        }
        if (nearest < 0)
            continue;
        const Vec2d moved = linear * Vec2d(place - Point2d(found.points1.at<Point2f>(nearest)));
        matches.push_back({Point2d(found.points2.at<Point2f>(nearest)) + Point2d(moved), points[row],
                mapImage.sees[row], nearest, cvRound(least), (int)view, (int)row, Vec2f(1, zoom)});
    }
    return matches;
}

}  // namespace cv::iib
