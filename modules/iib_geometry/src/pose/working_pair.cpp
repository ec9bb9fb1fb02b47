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

//! Of a type that can be matched; others are left to the extractor, which says what is wrong with them.
bool isReducible(const Mat& image)
{
    const int depth = image.depth(), channels = image.channels();
    return !image.empty() && (depth == CV_8U || depth == CV_16U || depth == CV_32F) &&
           (channels == 1 || channels == 3 || channels == 4);
}

Mat reduced(const Mat& image, int factor)
{
    if (factor <= 1)
        return image;
    Mat result;
    const Size size(image.cols / factor, image.rows / factor);
    resize(image(Rect(Point(), size * factor)), result, size, 0, 0, INTER_AREA);
    return result;
}

Point2d rowOf(const Mat& points, int i) { return points.at<Vec2d>(i); }

//! Moves both images' points, N x 2, CV_64F.
Mat allMoved(const Matx33d& by, const Mat& points)
{
    Mat result = points.clone();
    for (int i = 0; i < points.rows; i++)
        result.at<Point2d>(i) = moved(by, rowOf(points, i));
    return result;
}

}  // namespace

Point2d moved(const Matx33d& by, const Point2d& point)
{
    const Vec3d q = by * Vec3d(point.x, point.y, 1);
    return {q[0] / q[2], q[1] / q[2]};
}

WorkingImage::WorkingImage(const Mat& image, const Mat& mask) : full_(image)
{
    if (mask.empty())
        return;
    if (mask.type() != CV_8UC1 || mask.size() != image.size())
        CV_Error(Error::StsBadArg, "alignImages: masks are CV_8UC1 of the image's size");
    mask_ = mask != 0;
}

int WorkingImage::factorFor(int workingSize) const
{
    const int longer = std::max(full_.rows, full_.cols);
    return std::min((longer + workingSize - 1) / workingSize, largestFactor());
}

int WorkingImage::largestFactor() const
{
    return isReducible(full_) ? std::max(std::min(full_.rows, full_.cols) / LEAST_SIDE, 1) : 1;
}

bool WorkingImage::shows(const Point2d& point, int factor) const
{
    const Rect2d squares(Point2d(-.5, -.5), Size2d(size(factor)));  // about the whole places of pixels
    if (!squares.contains(point))
        return false;
    if (mask_.empty())
        return true;
    const Point pixel(moved(enlarging(factor), point));
    return Rect(Point(), mask_.size()).contains(pixel) && mask_.at<uchar>(pixel);
}

//! What is left at the right and below a multiple of the factor is left out.
Mat WorkingImage::pixels(int factor) const { return reduced(full_, factor); }

const WorkingImage::Described& WorkingImage::described(int factor) const
{
    const std::lock_guard<std::mutex> lock(mutex_);
    const auto known = described_.find(factor);
    if (known != described_.end())
        return known->second;
    Described found;
    const Mat mask = mask_.empty() ? Mat() : Mat(reduced(mask_, factor) == 255);
    IIBDescriptorExtractor::createRecommended(FEATURES)->detectAndCompute(
            pixels(factor), mask, found.keypoints, found.codes);
    return described_[factor] = found;
}

const PreparedImage& WorkingImage::prepared(int factor) const
{
    const std::lock_guard<std::mutex> lock(mutex_);
    const auto known = prepared_.find(factor);
    return known != prepared_.end() ? known->second : prepared_[factor] = PreparedImage(pixels(factor));
}

WorkingPair::WorkingPair(
        const WorkingImage& reference, const WorkingImage& image, int workingSize, bool sameScale)
    : images_{&reference, &image}
{
    for (int i = 0; i < 2; i++)
        factors_[i] = images_[i]->factorFor(workingSize);
    // Images of about one size keep their scales to each other, and a translation stays one.
    const int larger = std::max(factors_[0], factors_[1]), smaller = std::min(factors_[0], factors_[1]);
    if (sameScale || larger <= 2 * smaller)
        factors_[0] = factors_[1] = std::min({larger, reference.largestFactor(), image.largestFactor()});
    for (int& factor : factors_)
        factor = std::max(factor, 1);  // of an empty image
}

AlignedPoints WorkingPair::match(bool rotated) const
{
    const Ptr<HierarchicalMatcher> matcher = HierarchicalMatcher::createRecommended();
    const WorkingImage::Described &first = images_[0]->described(factors_[0]),
                                  &second = images_[1]->described(factors_[1]);
    AlignedPoints result = {Mat(0, 2, CV_64F), Mat(0, 2, CV_64F), {first.keypoints, second.keypoints}};
    std::vector<DMatch> matches;
    if (!rotated)
        matcher->match(first.codes, second.codes, matches);
    else if (!result.keypoints[0].empty() && !result.keypoints[1].empty())
    {
        const Ptr<IIBDescriptorExtractor> extractor = IIBDescriptorExtractor::createRecommended(FEATURES);
        extractor->setOrientation(IIBDescriptorExtractor::ORIENTATION_KEYPOINT);
        matchRotated(images_[0]->pixels(factors_[0]), result.keypoints[0], images_[1]->pixels(factors_[1]),
                result.keypoints[1], extractor, matcher, matches);
    }
    if (matches.empty())
        return result;
    Mat points1, points2;
    refineMatches(images_[0]->prepared(factors_[0]), result.keypoints[0], images_[1]->prepared(factors_[1]),
            result.keypoints[1], matches, points1, points2);
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
    refineMatches(images_[0]->prepared(1), first, images_[1]->prepared(1), second, matches, points1, points2,
            noArray(), similarities);
    AlignedPoints result = {Mat(0, 2, CV_64F), Mat(0, 2, CV_64F), {points.keypoints[0], points.keypoints[1]}};
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
    hconcat(allMoved(enlarging(factors_[0]), points.reference),
            allMoved(enlarging(factors_[1]), points.image), both);
    both.convertTo(both, CV_32F);
    for (int i = 0; i < both.rows; i++)
        if (agree[i])
            result.push_back(both.row(i));
    return result;
}

}  // namespace cv::iib
