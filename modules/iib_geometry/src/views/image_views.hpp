// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <memory>
#include <mutex>
#include <tuple>

#include "opencv2/iib.hpp"
#include "opencv2/iib/detail/prepared_image.hpp"
#include "view.hpp"

namespace cv::iib {

//! Keypoints in pixels of an image or a view, and their descriptors.
struct Described
{
    std::vector<KeyPoint> keypoints;
    Mat codes;
};

//! A view of an image, prepared for matching and refinement.
struct DescribedView : Described
{
    PreparedImage prepared;
    Matx33d fromImage;  //!< from pixels of the image to pixels of the view
};

//! An image and the features of its views, cached for matching with several images. Threads may share one object.
class ImageViews
{
public:
    /** @param image as in IIBDescriptorExtractor::compute; not copied.
    @param mask CV_8UC1 of the image's size, 0 where no keypoints are wanted, or empty.
    @param maxFeatures of a view.
    @throws cv::Exception (StsBadArg) for another mask. */
    ImageViews(const Mat& image, const Mat& mask, int maxFeatures);

    const Mat& image() const { return image_; }
    Size size() const { return image_.size(); }

    //! Whether a point lies in the image and its mask.
    bool shows(const Point2d& point) const;

    //! A view with upright features; cached.
    std::shared_ptr<const DescribedView> described(const View& view) const;

    /** A part of a view, with rotated features; not cached.
    @param angle of all features, degrees.
    @param part corners of a convex part, pixels of the image. */
    std::shared_ptr<const DescribedView> described(
            const View& view, float angle, const std::vector<Point2d>& part) const;

    //! A view prepared for refinement; that of the image itself is cached.
    std::shared_ptr<const PreparedImage> prepared(const View& view) const;

    /** The strongest points of a coarse view, or of each tile of one that is larger than COARSE_SIDE, described at each angle; cached.
    @param angles degrees, or -1.
    @param side pixels to which the image's longer side is reduced before. */
    const std::vector<Described>& coarse(
            const View& view, const std::vector<float>& angles, int side = COARSE_SIDE) const;

    //! From pixels of the image to pixels of coarse().
    Matx33d toCoarse(const View& view, int side = COARSE_SIDE) const;

    static constexpr int COARSE_SIDE = 640;

private:
    std::shared_ptr<const DescribedView> extract(
            const Mat& pixels, const Mat& mask, float angle, int workingSize, const Matx33d& fromImage) const;

    View coarseView(int side) const;

    const Mat image_, mask_;
    const int maxFeatures_;
    mutable std::mutex mutex_;
    //! Reduced images and masks for coarse(), by their longer sides.
    mutable std::map<int, std::pair<Mat, Mat>> bases_;
    mutable std::shared_ptr<const PreparedImage> prepared_;
    mutable std::map<View, std::shared_ptr<const DescribedView>> described_;
    mutable std::map<std::tuple<View, std::vector<float>, int>, std::vector<Described>> coarse_;
};

//! Matches two views by the recommended matcher.
std::vector<DMatch> matchesOf(const DescribedView& first, const DescribedView& second);

}  // namespace cv::iib
