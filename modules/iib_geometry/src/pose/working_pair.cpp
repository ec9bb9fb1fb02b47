// SPDX-License-Identifier: Apache-2.0
#include "working_pair.hpp"

#include "opencv2/imgproc.hpp"

namespace cv::iib {
namespace {

const int FEATURES = 2000;

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

WorkingPair::WorkingPair(const Mat& reference, const Mat& image, int workingSize)
{
    const Mat* const images[] = {&reference, &image};
    for (int i = 0; i < 2; i++)
    {
        const Mat& whole = full_[i] = *images[i];
        const int longer = std::max(whole.rows, whole.cols);
        factors_[i] = std::max((longer + workingSize - 1) / workingSize, 1);
        working_[i] = whole;
        const Size size(whole.cols / factors_[i], whole.rows / factors_[i]);
        if (factors_[i] > 1 && !size.empty())  // what is left at the right and below a multiple is left out
            resize(whole(Rect(Point(), size * factors_[i])), working_[i], size, 0, 0, INTER_AREA);
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
