// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "../common/points.hpp"
#include "../verdict/spread.hpp"
#include "../views/image_views.hpp"

namespace cv::iib {

//! Refined matches of two images, in working pixels.
struct AlignedPoints
{
    Points reference, image;
    std::vector<KeyPoint> keypoints[2];  //!< all keypoints of both images
};

//! The marked matches, without keypoints.
AlignedPoints marked(const AlignedPoints& points, const std::vector<bool>& marks);

/** Two images, the views in which they are matched, and the refinement of their matches at full size. Working pixels are pixels of the
views. */
class WorkingPair
{
public:
    /** Upright views, reduced by whole factors.
    @param workingSize largest longer side, pixels.
    @param sameScale whether both are reduced by one factor, however their sizes differ. */
    WorkingPair(const ImageViews& reference, const ImageViews& image, int workingSize, bool sameScale);

    /** The views in which a search found the images alike, in the parts that both show.
    @param map from pixels of the reference to pixels of the image. */
    WorkingPair(const ImageViews& reference, const ImageViews& image, int workingSize, const Matx33d& map);

    AlignedPoints match() const;

    //! Whether refined() may be more exact.
    bool isReduced() const;

    /** The matches that agree with a transform of working pixels, refined again at full size. Matches that cannot be refined there, as in
    blurred images, are left out. */
    AlignedPoints refined(
            const AlignedPoints& points, const std::vector<bool>& agree, const Matx33d& transform) const;

    /** The part of one image that the other one shows as well, in the image's own pixels.
    @param which 0 for the reference, 1 for the image.
    @param transform from the image to the reference, working pixels. */
    SharedPart sharedPart(int which, const AlignedPoints& points, const std::vector<bool>& agree,
            const Matx33d& transform) const;

    const Mat& pixels(int which) const { return images_[which]->image(); }

    //! Corners of the image, working pixels.
    std::vector<Point2d> imageCorners() const;

    //! The reference as it is matched, if both images have the same view; else empty.
    Mat sameView() const;

    double imageDiagonal() const { return norm(imageCorners()[2] - imageCorners()[0]); }

    //! A transform between the images' own pixels; a distance in the reference's, along the axis that is reduced most.
    Matx33d inPixels(const Matx33d& transform) const;
    double inPixels(double distance) const;

    //! The matches that agree, M x 4, CV_32F: x and y in the reference, x and y in the image, their own pixels.
    Mat inPixels(const AlignedPoints& points, const std::vector<bool>& agree) const;

private:
    const ImageViews* images_[2];
    ViewPair views_;
    std::shared_ptr<const DescribedView> described_[2];
};

}  // namespace cv::iib
