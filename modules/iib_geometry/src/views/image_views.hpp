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

//! A view of an image with all that it is matched and refined by.
struct SeenView : Described
{
    PreparedImage prepared;
    Matx33d fromImage;  //!< pixels of the image to pixels of the view
};

/** An image and what was found in its views. What can serve with other images is kept. Threads may share one. */
class ImageViews
{
public:
    /** @param image as IIBDescriptorExtractor::compute takes it; not copied.
    @param mask CV_8UC1 of the image's size, 0 where no points are to be found, or empty.
    @param maxFeatures of a view.
    @throws cv::Exception (StsBadArg) for another mask. */
    ImageViews(const Mat& image, const Mat& mask, int maxFeatures);

    const Mat& image() const { return image_; }
    Size size() const { return image_.size(); }

    //! Whether the image has a pixel there that its mask allows.
    bool shows(const Point2d& point) const;

    //! With upright features.
    std::shared_ptr<const SeenView> seen(const View& view) const;

    /** With features that all are turned by one angle, of a part of the image. Not kept.
    @param angle degrees.
    @param part corners of a convex part, pixels of the image. */
    std::shared_ptr<const SeenView> seen(
            const View& view, float angle, const std::vector<Point2d>& part) const;

    //! To refine matches of any keypoints. That of the image is kept.
    std::shared_ptr<const PreparedImage> prepared(const View& view) const;

    //! The strongest points of a view, described at each of several angles, degrees or -1; for one image the same in all calls.
    const std::vector<Described>& few(const View& view, const std::vector<float>& angles) const;

    //! The same, not kept.
    std::vector<Described> fewOnce(const View& view, const std::vector<float>& angles) const;

    //! Where the views of few() show the image's pixels: large images are reduced before.
    Matx33d toFew(const View& view) const;

private:
    std::shared_ptr<const SeenView> look(const View& view, float angle, const Mat& mask) const;

    View searched() const;
    std::vector<Described> describedAt(const View& view, const std::vector<float>& angles) const;

    const Mat image_, mask_;
    const int maxFeatures_;
    mutable std::mutex mutex_;
    mutable Mat base_, baseMask_;  //!< the image reduced for few()
    mutable std::shared_ptr<const PreparedImage> prepared_;
    mutable std::map<View, std::shared_ptr<const SeenView>> seen_;
    mutable std::map<View, std::vector<Described>> few_;
};

/** Corners of an image with a margin, where a map has them: what it shows of another one.
@param map from pixels of the image to those of the other one. */
std::vector<Point2d> cornersAround(const Size& image, const Matx33d& map);

//! Matches of two views by the recommended matcher.
std::vector<DMatch> matchesOf(const SeenView& first, const SeenView& second);

}  // namespace cv::iib
