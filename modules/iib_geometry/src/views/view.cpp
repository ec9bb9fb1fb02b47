// SPDX-License-Identifier: Apache-2.0
#include "view.hpp"

#include "../common/points.hpp"

#include <tuple>

#include "opencv2/imgproc.hpp"

namespace cv::iib {
namespace {

const int LEAST_SIDE = 16;           // pixels of a view
const double LEAST_TILT = 1.25;      // smaller tilts become one scale for both axes
const double LEAST_SHORTENED = .95;  // larger scales become 1
const int SMALL = 480;               // pixels of the longest side: smaller views are enlarged
const double MOST_ENLARGED = 2;      // factor: further enlargement gives no more points

Mat affine(const Matx33d& map) { return Mat(map.get_minor<2, 3>(0, 0)); }

//! The view of a rotation and two scales, with one scale if they differ little.
View viewOf(double longitude, Vec2d scales)
{
    for (int axis = 0; axis < 2; axis++)
        if (scales[axis] > LEAST_SHORTENED)
            scales[axis] = 1;
    const double tilt = std::max(scales[0], scales[1]) / std::min(scales[0], scales[1]);
    return tilt < LEAST_TILT ? View::reduced(std::sqrt(scales[0] * scales[1])) : View{longitude, scales};
}

}  // namespace

bool View::operator<(const View& other) const
{
    return std::tie(longitude, scales[0], scales[1]) <
           std::tie(other.longitude, other.scales[0], other.scales[1]);
}

Size View::turnedSize(const Size& image) const
{
    if (longitude == 0)
        return image;
    const double c = std::abs(std::cos(longitude)), s = std::abs(std::sin(longitude));
    return Size(cvCeil(image.width * c + image.height * s), cvCeil(image.width * s + image.height * c));
}

//! The rotation about the centres of the image and the rotated image.
Matx33d View::turn(const Size& image) const
{
    const double c = std::cos(longitude), s = std::sin(longitude);
    const Size turned = turnedSize(image);
    const double x = (image.width - 1) / 2., y = (image.height - 1) / 2.;
    return Matx33d(c, s, (turned.width - 1) / 2. - c * x - s * y, -s, c,
            (turned.height - 1) / 2. + s * x - c * y, 0, 0, 1);
}

//! The size shown by a view: for a whole factor, a multiple of it, without the remaining columns and rows.
Size View::shownSize(const Size& image) const
{
    const int factor = cvRound(1 / scales[0]);
    if (longitude != 0 || scales != Vec2d::all(1. / factor) ||
            factor * LEAST_SIDE > std::min(image.width, image.height))
        return turnedSize(image);
    return Size(image.width / factor, image.height / factor) * factor;
}

Size View::sizeOf(const Size& image) const
{
    if (isImage())
        return image;
    const Size shown = shownSize(image);
    return Size(std::max(cvRound(shown.width * scales[0]), LEAST_SIDE),
            std::max(cvRound(shown.height * scales[1]), LEAST_SIDE));
}

Matx33d View::fromImage(const Size& image) const
{
    if (isImage())
        return Matx33d::eye();
    const Size shown = shownSize(image), size = sizeOf(image);
    const double x = (double)size.width / shown.width, y = (double)size.height / shown.height;
    return Matx33d(x, 0, .5 * x - .5, 0, y, .5 * y - .5, 0, 0, 1) * turn(image);
}

Mat View::pixels(const Mat& image) const
{
    if (isImage() || image.empty() ||
            (image.depth() != CV_8U && image.depth() != CV_16U && image.depth() != CV_32F))
        return image;  // the extractor reports the error
    Mat turned = image, view;
    if (longitude == 0)
        turned = image(Rect(Point(), shownSize(image.size())));
    else
        warpAffine(image, turned, affine(turn(image.size())), turnedSize(image.size()), INTER_LINEAR,
                BORDER_REFLECT_101);
    resize(turned, view, sizeOf(image.size()), 0, 0, scales[1] > 1 ? INTER_CUBIC : INTER_AREA);
    return view;
}

Mat View::mask(const Size& image, const Mat& mask) const
{
    if (mask.empty() && longitude == 0)
        return Mat();
    const Mat all = mask.empty() ? Mat(image, CV_8U, Scalar(255)) : mask;
    Mat view;
    warpAffine(all, view, affine(fromImage(image)), sizeOf(image), INTER_NEAREST);
    return view;
}

ViewPair ViewPair::of(const Matx33d& affine)
{
    const Matx22d map = affine.get_minor<2, 2>(0, 0);
    Vec2d s;
    Matx22d U, Vt;
    SVD::compute(map, s, U, Vt);
    ViewPair pair;
    const Matx22d V = Vt.t();
    pair.views[0] = viewOf(std::atan2(V(1, 0), V(0, 0)), {std::min(s[0], 1.), std::min(s[1], 1.)});
    pair.views[1] = viewOf(std::atan2(U(1, 0), U(0, 0)), {std::min(1 / s[0], 1.), std::min(1 / s[1], 1.)});
    const auto shape = [](const View& view) {
        const double c = std::cos(view.longitude), sn = std::sin(view.longitude);
        return Matx22d::diag(view.scales) * Matx22d(c, sn, -sn, c);
    };
    const Matx22d left = shape(pair.views[1]) * map * shape(pair.views[0]).inv();
    const double angle = std::atan2(left(1, 0) - left(0, 1), left(0, 0) + left(1, 1)) * 180 / CV_PI;
    pair.angle = angle < 0 ? angle + 360 : angle;
    return pair;
}

ViewPair ViewPair::within(int most, const Size& image1, const Size& image2, const Matx33d& map) const
{
    const Size sizes[] = {image1, image2};
    int longest = 1, longestPart = 1;
    for (int i = 0; i < 2; i++)
    {
        const Size whole = views[i].sizeOf(sizes[i]);
        const Matx33d fromOther = views[i].fromImage(sizes[i]) * (i ? map : map.inv());
        const Rect part = boxOf(cornersAround(sizes[!i], fromOther, 0), whole);
        longest = std::max({longest, whole.width, whole.height});
        const Size shown = part.empty() ? whole : part.size();
        longestPart = std::max({longestPart, shown.width, shown.height});
    }
    const double reduced = std::max(longestPart, std::min(longest, WORKING_SIZE));
    ViewPair pair = *this;
    for (View& view : pair.views)
        view.scales *= std::min(std::clamp((double)SMALL / longest, 1., MOST_ENLARGED), most / reduced);
    return pair;
}

std::vector<Point2d> cornersAround(const Size& image, const Matx33d& map, double share)
{
    const Point2d margin(share * image.width, share * image.height), end(image.width - 1, image.height - 1);
    const Point2d low = -margin, high = end + margin;
    std::vector<Point2d> corners;
    for (const Point2d& corner : {low, Point2d(high.x, low.y), high, Point2d(low.x, high.y)})
        corners.push_back(moved(map, corner));
    return corners;
}

Rect boxOf(const std::vector<Point2d>& points, const Size& image)
{
    Point2d low(image.width, image.height), high(0, 0);
    for (const Point2d& point : points)
    {
        low = {std::min(low.x, point.x), std::min(low.y, point.y)};
        high = {std::max(high.x, point.x), std::max(high.y, point.y)};
    }
    const Point from(cvFloor(std::max(low.x, 0.)), cvFloor(std::max(low.y, 0.))),
            to(cvFloor(std::min(high.x, image.width - 1.)) + 1,
                    cvFloor(std::min(high.y, image.height - 1.)) + 1);
    return from.x < to.x && from.y < to.y ? Rect(from, to) : Rect();
}

Matx33d affineAt(const Matx33d& transform, const Point2d& point)
{
    const double step = .5;  // pixels
    const Point2d x = moved(transform, point + Point2d(step, 0)) - moved(transform, point - Point2d(step, 0)),
                  y = moved(transform, point + Point2d(0, step)) - moved(transform, point - Point2d(0, step)),
                  there = moved(transform, point);
    return {x.x, y.x, there.x - x.x * point.x - y.x * point.y, x.y, y.y,
            there.y - x.y * point.x - y.y * point.y, 0, 0, 1};
}

Matx33d similarityOf(const Matx33d& map)
{
    const double c = (map(0, 0) + map(1, 1)) / 2, s = (map(1, 0) - map(0, 1)) / 2;
    return {c, -s, map(0, 2), s, c, map(1, 2), 0, 0, 1};
}

bool haveSimilarViews(const Matx33d& map, const Matx33d& other)
{
    const Matx33d between = map * other.inv(), turn = similarityOf(between);
    Vec2d scales;
    SVD::compute(between.get_minor<2, 2>(0, 0), scales, SVD::NO_UV);
    return scales[0] < MOST_SCALE && scales[1] > 1 / MOST_SCALE &&
           std::abs(std::atan2(turn(1, 0), turn(0, 0))) < MOST_TURN;
}

bool showSameParts(const Matx33d& map, const Matx33d& other, const Size& image)
{
    const double margin = .1 * std::max(image.width, image.height);  // as cornersAround() leaves
    for (const Point2d& corner : cornersAround(image, map * other.inv(), 0))
        if (!Rect2d(Point2d(-margin, -margin), Point2d(image.width + margin, image.height + margin))
                        .contains(corner))
            return false;
    return true;
}

}  // namespace cv::iib
