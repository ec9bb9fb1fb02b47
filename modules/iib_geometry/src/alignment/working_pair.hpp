// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "../common/points.hpp"
#include "../verdict/spread.hpp"
#include "../views/image_views.hpp"

namespace cv::iib {

//! Refined matches of two images, N x 2 each, CV_64F, in working pixels, and what they come from.
struct AlignedPoints
{
    Mat reference, image;
    std::vector<KeyPoint> keypoints[2];  //!< of both, all that were looked for
    std::vector<float> sizes;            //!< of the matches' keypoints in the reference
};

/** Two images that are matched in views of them, and whose matches are refined at full size afterwards. Working pixels are those of the
views. */
class WorkingPair
{
public:
    /** Both upright and not tilted, reduced by whole factors.
    @param workingSize pixels of the longer side, at most.
    @param sameScale whether both are reduced by one factor, however their sizes differ. */
    WorkingPair(const ImageViews& reference, const ImageViews& image, int workingSize, bool sameScale);

    /** In the views in which a search found them alike, at most as large, in the parts that both show.
    @param map from pixels of the reference to pixels of the image. */
    WorkingPair(const ImageViews& reference, const ImageViews& image, int workingSize, const Matx33d& map);

    AlignedPoints match() const;

    //! Whether refined() may be more exact.
    bool isReduced() const;

    /** Matches again, at full size, those that agree with a transform of working pixels, from where it has them; without those that
    cannot be refined, as where the images are blurred. */
    AlignedPoints refined(
            const AlignedPoints& points, const std::vector<bool>& agree, const Matx33d& transform) const;

    /** What one of both has where the other one shows the same, in its own pixels.
    @param which 0 for the reference, 1 for the image.
    @param transform from the image to the reference, working pixels. */
    SharedPart sharedPart(int which, const AlignedPoints& points, const std::vector<bool>& agree,
            const Matx33d& transform) const;

    //! Corners of the image, working pixels.
    std::vector<Point2d> imageCorners() const;

    //! The reference as it is matched, where both images are seen in the same view; else empty.
    Mat sameView() const;

    double imageDiagonal() const { return norm(imageCorners()[2] - imageCorners()[0]); }

    //! A transform between the images' own pixels, and a distance in the reference's, along the axis that is shortened most.
    Matx33d inPixels(const Matx33d& transform) const;
    double inPixels(double distance) const;

    //! Those that agree, M x 4, CV_32F: x and y in the reference, x and y in the image, their own pixels.
    Mat inPixels(const AlignedPoints& points, const std::vector<bool>& agree) const;

private:
    const ImageViews* images_[2];
    ViewPair views_;
    std::shared_ptr<const SeenView> seen_[2];
};

}  // namespace cv::iib
