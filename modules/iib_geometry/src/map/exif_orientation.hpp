// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "opencv2/iib/localization.hpp"

namespace cv::iib {

//! Converts between images as their files store them, with EXIF's orientation, and upright images, as maps have them.
class Upright
{
public:
    /** @param size of the image in its file.
    @param orientation 1, 3, 6 or 8.
    @throws cv::Exception (StsBadArg) for another orientation: no camera sees a mirrored image. */
    Upright(const Size& size, int orientation);

    Mat image(const Mat& stored) const;
    Camera camera(const Camera& stored) const;
    Affine3d pose(const Affine3d& stored) const { return Affine3d(fromStored_) * stored; }

    Affine3d storedPose(const Affine3d& upright) const { return Affine3d(fromStored_.t()) * upright; }
    Point2d storedPixel(const Point2d& upright) const;

private:
    int orientation_;
    Size size_;
    Matx33d fromStored_;  //!< rotation about the optical axis
};

}  // namespace cv::iib
