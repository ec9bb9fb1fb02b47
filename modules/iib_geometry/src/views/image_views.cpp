// SPDX-License-Identifier: Apache-2.0
#include "image_views.hpp"

#include "../common/points.hpp"
#include "opencv2/imgproc.hpp"

namespace cv::iib {
namespace {

const int COARSE_POINTS = 270;  // of a square of COARSE_SIDE
const int MARGIN = 64;          // pixels around a part of a view

//! @param workingSize as in HessianDetector.
Ptr<IIBDescriptorExtractor> extractorOf(int points, bool upright, int workingSize)
{
    const Ptr<HessianDetector> detector = HessianDetector::create(points);
    detector->setWorkingSize(workingSize);
    const Ptr<IIBDescriptorExtractor> extractor =
            IIBDescriptorExtractor::createFor(detector, IIBDescriptorExtractor::PRESET_UNIVERSAL);
    if (!upright)
        extractor->setOrientation(IIBDescriptorExtractor::ORIENTATION_KEYPOINT);
    return extractor;
}

void setAngle(std::vector<KeyPoint>& keypoints, float angle)
{
    for (KeyPoint& keypoint : keypoints)
        keypoint.angle = angle;
}

/** Keeps the strongest points of each tile, so that every part of a large image has some.
@param keypoints sorted by response.
@param toTiles from pixels of the view to pixels of the reduced image. */
void keepStrongest(std::vector<KeyPoint>& keypoints, const Matx33d& toTiles)
{
    std::map<std::pair<int, int>, int> kept;
    const auto isWeak = [&](const KeyPoint& keypoint) {
        const Point2d tile = moved(toTiles, keypoint.pt) / ImageViews::COARSE_SIDE;
        return kept[{cvFloor(tile.x), cvFloor(tile.y)}]++ >= COARSE_POINTS;
    };
    keypoints.erase(std::remove_if(keypoints.begin(), keypoints.end(), isWeak), keypoints.end());
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

std::shared_ptr<const DescribedView> ImageViews::extract(
        const Mat& pixels, const Mat& mask, float angle, int workingSize, const Matx33d& fromImage) const
{
    const std::shared_ptr<DescribedView> found = std::make_shared<DescribedView>();
    found->fromImage = fromImage;
    const Ptr<IIBDescriptorExtractor> extractor = extractorOf(maxFeatures_, angle < 0, workingSize);
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
        kept = extract(
                view.pixels(image_), view.mask(size(), mask_), -1, WORKING_SIZE, view.fromImage(size()));
    return kept;
}

std::shared_ptr<const DescribedView> ImageViews::described(
        const View& view, float angle, const std::vector<Point2d>& part) const
{
    const int margin = cvCeil(std::min(
            MARGIN / std::min(view.scales[0], view.scales[1]), (double)std::max(image_.rows, image_.cols)));
    const Rect box = boxOf(part, size());
    if (box.empty())
    {
        const std::shared_ptr<DescribedView> nothing = std::make_shared<DescribedView>();
        nothing->fromImage = view.fromImage(size());
        return nothing;
    }
    const Rect shown =
            Rect(box.tl() - Point(margin, margin), box.br() + Point(margin, margin)) & Rect(Point(), size());
    const Matx33d fromImage = view.fromImage(shown.size()) * Matx33d(1, 0, -shown.x, 0, 1, -shown.y, 0, 0, 1);
    Mat mask(view.sizeOf(shown.size()), CV_8U, Scalar(0));
    std::vector<Point> corners;
    for (const Point2d& corner : part)
        corners.push_back(Point(moved(fromImage, corner)));
    fillConvexPoly(mask, corners, Scalar(255));
    const Mat all = view.mask(shown.size(), mask_.empty() ? mask_ : mask_(shown));
    if (!all.empty())
        mask &= all;
    return extract(view.pixels(image_(shown)), mask, angle, 0, fromImage);
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

const std::vector<Described>& ImageViews::coarse(
        const View& view, const std::vector<float>& angles, int side) const
{
    const std::lock_guard<std::mutex> lock(mutex_);
    std::vector<Described>& found = coarse_[{view, angles, side}];
    if (!found.empty())
        return found;
    const View reduced = coarseView(side);
    Mat &base = bases_[side].first, &mask = bases_[side].second;
    if (base.empty())
    {
        base = reduced.pixels(image_);
        mask = mask_.empty() ? Mat() : reduced.mask(size(), mask_);
    }
    const Mat pixels = view.pixels(base);
    const Ptr<IIBDescriptorExtractor> extractor =
            extractorOf(side > COARSE_SIDE ? 0 : COARSE_POINTS, false, 0);
    std::vector<KeyPoint> keypoints, all;
    extractor->detect(pixels, keypoints, view.mask(base.size(), mask));
    keepStrongest(keypoints, view.fromImage(base.size()).inv());
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

View ImageViews::coarseView(int side) const
{
    return View::reduced(std::min(1., side / (double)std::max(image_.rows, image_.cols)));
}

Matx33d ImageViews::toCoarse(const View& view, int side) const
{
    return view.fromImage(coarseView(side).sizeOf(size())) * coarseView(side).fromImage(size());
}

std::vector<DMatch> matchesOf(const DescribedView& first, const DescribedView& second)
{
    std::vector<DMatch> matches;
    if (!first.codes.empty() && !second.codes.empty())
        HierarchicalMatcher::createRecommended()->match(first.codes, second.codes, matches);
    return matches;
}

}  // namespace cv::iib
