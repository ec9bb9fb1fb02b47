// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "opencv2/iib/localization.hpp"

namespace iib_localization {

using cv::iib::Camera;

/** What a camera does to rays, by OpenCV's functions. Here and everywhere but in COLMAP's files, the centre of the first pixel
is (0, 0). */
class Lens
{
public:
    //! @throws cv::Exception for a camera that is none, and naming a model that is not known here.
    explicit Lens(const Camera& camera);

    //! Of a camera without distortion that undistorted() gives the pixels of.
    const cv::Matx33d& matrix() const { return matrix_; }
    std::vector<cv::Point2d> undistorted(const std::vector<cv::Point2d>& pixels) const;
    /** Where points in the camera's axes are seen; NaN behind it.
    @param jacobian if not null: 2 N x 3, of the pixels by the points. */
    std::vector<cv::Point2d> project(
            const std::vector<cv::Point3d>& points, cv::Mat* jacobian = nullptr) const;

private:
    cv::Matx33d matrix_;
    bool fisheye_;
    std::vector<double> distortion_;
};

}  // namespace iib_localization
