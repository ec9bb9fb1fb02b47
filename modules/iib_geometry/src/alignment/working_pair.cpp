// SPDX-License-Identifier: Apache-2.0
#include "working_pair.hpp"

namespace cv::iib {
namespace {

const int LEAST_SIDE = 64;  // pixels of the shorter side of a reduced image

int largestFactor(const Size& size) { return std::max(std::min(size.width, size.height) / LEAST_SIDE, 1); }

const int SAMPLES_ACROSS = 32;  // of the grid that measures the area that both images show

}  // namespace

AlignedPoints marked(const AlignedPoints& points, const std::vector<bool>& marks)
{
    AlignedPoints some;
    for (size_t i = 0; i < marks.size(); i++)
        if (marks[i])
        {
            some.reference.push_back(points.reference[i]);
            some.image.push_back(points.image[i]);
        }
    return some;
}

WorkingPair::WorkingPair(
        const ImageViews& reference, const ImageViews& image, int workingSize, bool sameScale)
    : images_{&reference, &image}
{
    int factors[2];
    for (int i = 0; i < 2; i++)
    {
        const Size size = images_[i]->size();
        factors[i] = std::clamp(
                (std::max(size.width, size.height) + workingSize - 1) / workingSize, 1, largestFactor(size));
    }
    // Images of about one size keep their scales to each other, and a translation stays one.
    const int larger = std::max(factors[0], factors[1]), smaller = std::min(factors[0], factors[1]);
    if (sameScale || larger <= 2 * smaller)
        factors[0] = factors[1] =
                std::min({larger, largestFactor(reference.size()), largestFactor(image.size())});
    for (int i = 0; i < 2; i++)
    {
        views_.views[i] = View::reduced(1. / factors[i]);
        described_[i] = images_[i]->described(views_.views[i]);
    }
}

WorkingPair::WorkingPair(
        const ImageViews& reference, const ImageViews& image, int workingSize, const Matx33d& map)
    : images_{&reference, &image},
      views_(ViewPair::of(map).within(workingSize, reference.size(), image.size(), map))
{
    described_[0] = reference.described(views_.views[0], -1, cornersAround(image.size(), map.inv()));
    described_[1] =
            image.described(views_.views[1], (float)views_.angle, cornersAround(reference.size(), map));
}

AlignedPoints WorkingPair::match() const
{
    AlignedPoints result = {{}, {}, {described_[0]->keypoints, described_[1]->keypoints}};
    const std::vector<DMatch> matches = matchesOf(*described_[0], *described_[1]);
    if (matches.empty())
        return result;
    Mat points1, points2;
    refineMatches(described_[0]->prepared, result.keypoints[0], described_[1]->prepared, result.keypoints[1],
            matches, points1, points2);
    points1.reshape(2).convertTo(result.reference, CV_64F);
    points2.reshape(2).convertTo(result.image, CV_64F);
    return result;
}

bool WorkingPair::isReduced() const
{
    const double largest = .9;  // scale at which hardly anything is lost
    return std::all_of(std::begin(views_.views), std::end(views_.views),
            [&](const View& view) { return std::max(view.scales[0], view.scales[1]) < largest; });
}

AlignedPoints WorkingPair::refined(
        const AlignedPoints& points, const std::vector<bool>& agree, const Matx33d& transform) const
{
    const double size = 10;  // pixels: only the ratio of the two sizes counts
    const Matx33d toImage = inPixels(transform).inv();
    const Scalar centre = mean(inPixels(points, agree).reshape(4));
    const ViewPair full = ViewPair::of(affineAt(toImage, Point2d(centre[0], centre[1])));
    Matx33d fromImage[2], toWorking[2];
    std::shared_ptr<const PreparedImage> prepared[2];
    for (int i = 0; i < 2; i++)
    {
        fromImage[i] = full.views[i].fromImage(images_[i]->size());
        toWorking[i] = described_[i]->fromImage * fromImage[i].inv();
        prepared[i] = images_[i]->prepared(full.views[i]);
    }
    const Matx33d between = fromImage[1] * toImage * fromImage[0].inv();
    std::vector<KeyPoint> first, second;
    std::vector<DMatch> matches;
    for (size_t i = 0; i < agree.size(); i++)
    {
        if (!agree[i])
            continue;
        const Point2d from = moved(toWorking[0].inv(), points.reference[i]), to = moved(between, from),
                      beside = moved(between, from + Point2d(1, 0)) - to;
        const double angle = fastAtan2((float)beside.y, (float)beside.x);
        first.emplace_back(Point2f(from), (float)size, 0.f);
        second.emplace_back(Point2f(to), (float)(size * norm(beside)), (float)angle);
        matches.emplace_back((int)matches.size(), (int)matches.size(), 0.f);
    }
    Mat points1, points2, similarities;
    refineMatches(
            *prepared[0], first, *prepared[1], second, matches, points1, points2, noArray(), similarities);
    AlignedPoints result = {{}, {}, {points.keypoints[0], points.keypoints[1]}};
    for (size_t i = 0; i < matches.size(); i++)
        if (similarities.at<float>((int)i) >= 0)
        {
            result.reference.push_back(moved(toWorking[0], points1.at<Point2f>((int)i)));
            result.image.push_back(moved(toWorking[1], points2.at<Point2f>((int)i)));
        }
    return result;
}

SharedPart WorkingPair::sharedPart(int which, const AlignedPoints& points, const std::vector<bool>& agree,
        const Matx33d& transform) const
{
    const Matx33d toImage = described_[which]->fromImage.inv(),
                  toOther = described_[!which]->fromImage.inv() * (which ? transform : transform.inv()) *
                            toImage.inv();
    const auto both = [&](const Point2d& point) {
        return images_[which]->shows(point) && images_[!which]->shows(moved(toOther, point));
    };
    SharedPart part;
    const Size size = images_[which]->size();
    const double width = (double)size.width / SAMPLES_ACROSS, height = (double)size.height / SAMPLES_ACROSS;
    double shown = 0;
    for (int row = 0; row < SAMPLES_ACROSS; row++)
        for (int column = 0; column < SAMPLES_ACROSS; column++)
        {
            const Point2d sample((column + .5) * width - .5, (row + .5) * height - .5);
            shown += images_[which]->shows(sample) ? width * height : 0;
            part.area += both(sample) ? width * height : 0;
        }
    part.share = part.area / std::max(shown, 1.);
    for (const KeyPoint& keypoint : points.keypoints[which])
    {
        const Point2d point = moved(toImage, keypoint.pt);
        if (both(point))
            part.points.push_back(point);
    }
    const Points& places = which ? points.image : points.reference;
    for (size_t i = 0; i < agree.size(); i++)
        if (agree[i])
        {
            const Point2d point = moved(toImage, places[i]);
            part.agreeing.push_back(point);
            const Point pixel(std::clamp(cvRound(point.x), 0, size.width - 1),
                    std::clamp(cvRound(point.y), 0, size.height - 1));
            part.values.push_back(mean(images_[which]->image()(Rect(pixel, Size(1, 1))))[0]);
        }
    return part;
}

std::vector<Point2d> WorkingPair::imageCorners() const
{
    return cornersAround(images_[1]->size(), described_[1]->fromImage, 0);
}

Mat WorkingPair::sameView() const
{
    const bool same = norm(described_[0]->fromImage, described_[1]->fromImage, NORM_INF) == 0;
    return same ? views_.views[0].pixels(images_[0]->image()) : Mat();
}

Matx33d WorkingPair::inPixels(const Matx33d& transform) const
{
    const Matx33d pixels = described_[0]->fromImage.inv() * transform * described_[1]->fromImage;
    return pixels * (1 / pixels(2, 2));
}

double WorkingPair::inPixels(double distance) const
{
    const Vec2d scales = views_.views[0].scales;
    return distance / std::min(scales[0], scales[1]);
}

Mat WorkingPair::inPixels(const AlignedPoints& points, const std::vector<bool>& agree) const
{
    const AlignedPoints some = marked(points, agree);
    Points both[2];
    Mat all(0, 4, CV_32F);
    if (some.image.empty())
        return all;
    perspectiveTransform(some.reference, both[0], described_[0]->fromImage.inv());
    perspectiveTransform(some.image, both[1], described_[1]->fromImage.inv());
    const int count = (int)some.image.size();  // of rows: OpenCV 5 makes a row of a vector
    hconcat(Mat(both[0]).reshape(1, count), Mat(both[1]).reshape(1, count), all);
    all.convertTo(all, CV_32F);
    return all;
}

}  // namespace cv::iib
