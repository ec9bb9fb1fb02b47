// SPDX-License-Identifier: Apache-2.0
#include "image_views.hpp"

#include "../common/points.hpp"
#include "opencv2/imgproc.hpp"

namespace cv::iib {
namespace {

const int COARSE_POINTS = 270;  // of a view, during the search
const int COARSE_SIDE = 640;    // pixels: longer side of an image, during the search

Ptr<IIBDescriptorExtractor> extractorOf(int points, bool upright)
{
    const Ptr<IIBDescriptorExtractor> extractor = IIBDescriptorExtractor::createRecommended(points);
    if (!upright)
        extractor->setOrientation(IIBDescriptorExtractor::ORIENTATION_KEYPOINT);
    return extractor;
}

void setAngle(std::vector<KeyPoint>& keypoints, float angle)
{
    for (KeyPoint& keypoint : keypoints)
        keypoint.angle = angle;
}

}  // namespace

ImageViews::ImageViews(const Mat& image, const Mat& mask, int maxFeatures)
    : image_(image), mask_(mask), maxFeatures_(maxFeatures)
{
    if (!mask.empty() && (mask.type() != CV_8UC1 || mask.size() != image.size()))
        CV_Error(Error::StsBadArg, "a mask must be CV_8UC1 and of its image's size");
}

bool ImageViews::shows(const Point2d& point) const
{
    const Point pixel(cvRound(point.x), cvRound(point.y));
    return Rect(Point(), size()).contains(pixel) && (mask_.empty() || mask_.at<uchar>(pixel));
}

std::shared_ptr<const DescribedView> ImageViews::extract(const View& view, float angle, const Mat& mask) const
{
    const std::shared_ptr<DescribedView> found = std::make_shared<DescribedView>();
    found->fromImage = view.fromImage(size());
    const Mat pixels = view.pixels(image_);
    const Ptr<IIBDescriptorExtractor> extractor = extractorOf(maxFeatures_, angle < 0);
    extractor->detect(pixels, found->keypoints, mask);
    setAngle(found->keypoints, angle);
    extractor->compute(pixels, found->keypoints, found->codes);
    if (!pixels.empty())
        found->prepared = PreparedImage(pixels);
    return found;
}

std::shared_ptr<const DescribedView> ImageViews::described(const View& view) const
{
    const std::lock_guard<std::mutex> lock(mutex_);
    std::shared_ptr<const DescribedView>& kept = described_[view];
    if (!kept)
        kept = extract(view, -1, view.mask(size(), mask_));
    return kept;
}

std::shared_ptr<const DescribedView> ImageViews::described(
        const View& view, float angle, const std::vector<Point2d>& part) const
{
    Mat mask(view.sizeOf(size()), CV_8U, Scalar(0));
    std::vector<Point> corners;
    for (const Point2d& corner : part)
        corners.push_back(Point(moved(view.fromImage(size()), corner)));
    fillConvexPoly(mask, corners, Scalar(255));
    const Mat all = view.mask(size(), mask_);
    if (!all.empty())
        mask &= all;
    return extract(view, angle, mask);
}

std::shared_ptr<const PreparedImage> ImageViews::prepared(const View& view) const
{
    if (!view.isImage())
        return std::make_shared<PreparedImage>(view.pixels(image_));
    const std::lock_guard<std::mutex> lock(mutex_);
    if (!prepared_)
        prepared_ = std::make_shared<PreparedImage>(image_);
    return prepared_;
}

const std::vector<Described>& ImageViews::coarse(const View& view, const std::vector<float>& angles) const
{
    const std::lock_guard<std::mutex> lock(mutex_);
    std::vector<Described>& found = coarse_[{view, angles}];
    if (!found.empty())
        return found;
    if (base_.empty())
    {
        base_ = coarseView().pixels(image_);
        baseMask_ = mask_.empty() ? Mat() : coarseView().mask(size(), mask_);
    }
    const Mat pixels = view.pixels(base_);
    const Ptr<IIBDescriptorExtractor> extractor = extractorOf(COARSE_POINTS, false);
    std::vector<KeyPoint> keypoints, all;
    extractor->detect(pixels, keypoints, view.mask(base_.size(), baseMask_));
    for (float angle : angles)
    {
        setAngle(keypoints, angle);
        all.insert(all.end(), keypoints.begin(), keypoints.end());
    }
    Mat codes;
    extractor->compute(pixels, all, codes);
    const int n = (int)keypoints.size();
    for (int k = 0; k < (int)angles.size(); k++)
        found.push_back({{all.begin() + k * n, all.begin() + (k + 1) * n},
                n ? codes.rowRange(k * n, (k + 1) * n) : Mat()});
    return found;
}

View ImageViews::coarseView() const
{
    return View::reduced(std::min(1., COARSE_SIDE / (double)std::max(image_.rows, image_.cols)));
}

Matx33d ImageViews::toCoarse(const View& view) const
{
    return view.fromImage(coarseView().sizeOf(size())) * coarseView().fromImage(size());
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

std::vector<DMatch> matchesOf(const DescribedView& first, const DescribedView& second)
{
    std::vector<DMatch> matches;
    if (!first.codes.empty() && !second.codes.empty())
        HierarchicalMatcher::createRecommended()->match(first.codes, second.codes, matches);
    return matches;
}

}  // namespace cv::iib
