// SPDX-License-Identifier: Apache-2.0
#include "working_pair.hpp"

#include "opencv2/imgproc.hpp"

namespace cv::iib {
namespace {

const int FEATURES = 2000;
const int LEAST_SIDE = 64;  // pixels that are left of a reduced image

//! From pixels of a reduced image to those of the whole one: the centres of pixels are at whole numbers in both.
Matx33d enlarging(int factor)
{
    const double shift = .5 * (factor - 1);
    return Matx33d(factor, 0, shift, 0, factor, shift, 0, 0, 1);
}

Point2d moved(const Matx33d& by, const Point2d& point)
{
    const Vec3d q = by * Vec3d(point.x, point.y, 1);
    return {q[0] / q[2], q[1] / q[2]};
}

//! Of a type that can be matched; others are left to the extractor, which says what is wrong with them.
bool isReducible(const Mat& image)
{
    const int depth = image.depth(), channels = image.channels();
    return !image.empty() && (depth == CV_8U || depth == CV_16U || depth == CV_32F) &&
           (channels == 1 || channels == 3 || channels == 4);
}

Point2d rowOf(const Mat& points, int i) { return points.at<Vec2d>(i); }

//! Moves both images' points, N x 2, CV_64F.
Mat moved(const Matx33d& by, const Mat& points)
{
    Mat result = points.clone();
    for (int i = 0; i < points.rows; i++)
        result.at<Point2d>(i) = moved(by, rowOf(points, i));
    return result;
}

}  // namespace

WorkingPair::WorkingPair(const Mat& reference, const Mat& image, int workingSize, bool sameScale)
    : full_{reference, image}
{
    int most[2];
    for (int i = 0; i < 2; i++)
    {
        const int longer = std::max(full_[i].rows, full_[i].cols),
                  shorter = std::min(full_[i].rows, full_[i].cols);
        most[i] = isReducible(full_[i]) ? std::max(shorter / LEAST_SIDE, 1) : 1;
        factors_[i] = std::min((longer + workingSize - 1) / workingSize, most[i]);
    }
    // Images of about one size keep their scales to each other, and a translation stays one.
    const int larger = std::max(factors_[0], factors_[1]), smaller = std::min(factors_[0], factors_[1]);
    if (sameScale || larger <= 2 * smaller)
        factors_[0] = factors_[1] = std::min({larger, most[0], most[1]});
    for (int i = 0; i < 2; i++)
    {
        working_[i] = full_[i];
        const Size size(full_[i].cols / std::max(factors_[i], 1), full_[i].rows / std::max(factors_[i], 1));
        if (factors_[i] > 1)  // what is left at the right and below a multiple is left out
            resize(full_[i](Rect(Point(), size * factors_[i])), working_[i], size, 0, 0, INTER_AREA);
        factors_[i] = std::max(factors_[i], 1);  // of an empty image
    }
}

AlignedPoints WorkingPair::match(bool rotated) const
{
    const Ptr<IIBDescriptorExtractor> extractor = IIBDescriptorExtractor::createRecommended(FEATURES);
    const Ptr<HierarchicalMatcher> matcher = HierarchicalMatcher::createRecommended();
    AlignedPoints result = {Mat(0, 2, CV_64F), Mat(0, 2, CV_64F), {}};
    std::vector<KeyPoint> keypoints;
    std::vector<DMatch> matches;
    if (rotated)
    {
        extractor->setOrientation(IIBDescriptorExtractor::ORIENTATION_KEYPOINT);
        matchRotated(working_[0], working_[1], extractor, matcher, result.keypoints, keypoints, matches);
    }
    else
    {
        Mat codes1, codes2;
        extractor->detectAndCompute(working_[0], noArray(), result.keypoints, codes1);
        extractor->detectAndCompute(working_[1], noArray(), keypoints, codes2);
        matcher->match(codes1, codes2, matches);
    }
    if (matches.empty())
        return result;
    Mat points1, points2;
    refineMatches(working_[0], result.keypoints, working_[1], keypoints, matches, points1, points2);
    points1.convertTo(result.reference, CV_64F);
    points2.convertTo(result.image, CV_64F);
    return result;
}

AlignedPoints WorkingPair::refined(
        const AlignedPoints& points, const std::vector<bool>& agree, const Matx33d& transform) const
{
    const double size = 10;  // pixels: the ratio of a match's sizes counts alone
    const Matx33d toImage = inPixels(transform).inv();
    std::vector<KeyPoint> first, second;
    std::vector<DMatch> matches;
    for (size_t i = 0; i < agree.size(); i++)
    {
        if (!agree[i])
            continue;
        const Point2d from = moved(enlarging(factors_[0]), rowOf(points.reference, (int)i)),
                      to = moved(toImage, from), beside = moved(toImage, from + Point2d(1, 0)) - to;
        const double angle = fastAtan2((float)beside.y, (float)beside.x);
        first.emplace_back(Point2f(from), (float)size, 0.f);
        second.emplace_back(Point2f(to), (float)(size * norm(beside)), (float)angle);
        matches.emplace_back((int)matches.size(), (int)matches.size(), 0.f);
    }
    Mat points1, points2, similarities;
    refineMatches(full_[0], first, full_[1], second, matches, points1, points2, noArray(), similarities);
    AlignedPoints result = {Mat(0, 2, CV_64F), Mat(0, 2, CV_64F), points.keypoints};
    for (size_t i = 0; i < matches.size(); i++)
        if (similarities.at<float>((int)i) >= 0)
        {
            const Point2d from = points1.at<Point2f>((int)i), to = points2.at<Point2f>((int)i);
            result.reference.push_back(Mat(Vec2d(moved(enlarging(factors_[0]).inv(), from))).t());
            result.image.push_back(Mat(Vec2d(moved(enlarging(factors_[1]).inv(), to))).t());
        }
    return result;
}

Matx33d WorkingPair::inPixels(const Matx33d& transform) const
{
    const Matx33d pixels = enlarging(factors_[0]) * transform * enlarging(factors_[1]).inv();
    return pixels * (1 / pixels(2, 2));
}

Mat WorkingPair::inPixels(const AlignedPoints& points, const std::vector<bool>& agree) const
{
    Mat both, result(0, 4, CV_32F);
    if (points.reference.empty())
        return result;
    hconcat(moved(enlarging(factors_[0]), points.reference), moved(enlarging(factors_[1]), points.image),
            both);
    both.convertTo(both, CV_32F);
    for (int i = 0; i < both.rows; i++)
        if (agree[i])
            result.push_back(both.row(i));
    return result;
}

}  // namespace cv::iib
