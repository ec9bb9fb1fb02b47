// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <memory>
#include <mutex>

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

    /** A view of a part of the image with rotated features; not cached.
    @param angle of all features, degrees.
    @param part corners of a convex part, pixels of the image. */
    std::shared_ptr<const DescribedView> described(
            const View& view, float angle, const std::vector<Point2d>& part) const;

    //! A view prepared for refinement; that of the image itself is cached.
    std::shared_ptr<const PreparedImage> prepared(const View& view) const;

    //! The strongest points of a coarse view, described at each angle (degrees or -1); cached.
    const std::vector<Described>& coarse(const View& view, const std::vector<float>& angles) const;

    //! From pixels of the image to pixels of coarse(view), in which large images are reduced.
    Matx33d toCoarse(const View& view) const;

private:
    std::shared_ptr<const DescribedView> extract(const View& view, float angle, const Mat& mask) const;

    View coarseView() const;

    const Mat image_, mask_;
    const int maxFeatures_;
    mutable std::mutex mutex_;
    mutable Mat base_, baseMask_;  //!< reduced image and mask for coarse()
    mutable std::shared_ptr<const PreparedImage> prepared_;
    mutable std::map<View, std::shared_ptr<const DescribedView>> described_;
    mutable std::map<std::pair<View, std::vector<float>>, std::vector<Described>> coarse_;
};

/** The corners of an image, with a margin, mapped to another image.
@param map from pixels of the image to pixels of the other image. @param share of the image's size. */
std::vector<Point2d> cornersAround(const Size& image, const Matx33d& map, double share = .1);

//! Matches two views by the recommended matcher.
std::vector<DMatch> matchesOf(const DescribedView& first, const DescribedView& second);

}  // namespace cv::iib
