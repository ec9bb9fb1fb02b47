// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "opencv2/iib/localization.hpp"

namespace cv::iib {

//! Projects points and undistorts pixels. The centre of the first pixel is (0, 0), unlike in COLMAP's files.
class Lens
{
public:
    //! @throws cv::Exception for invalid parameters and unknown models.
    explicit Lens(const Camera& camera);

    //! The matrix of the camera without distortion that undistorted() refers to.
    const Matx33d& matrix() const { return matrix_; }
    //! As Camera::undistorted.
    std::vector<Point2d> undistorted(const std::vector<Point2d>& pixels) const;
    /** Projects points in the camera's axes to pixels; NaN behind the camera and beyond the lens's range.
    @param jacobians if not null: receives derivatives of the pixels by the points. */
    std::vector<Point2d> project(
            const std::vector<Point3d>& points, std::vector<Matx23d>* jacobians = nullptr) const;

private:
    Vec2d distorted(const Vec2d& ray) const;
    Matx22d slope(const Vec2d& ray) const;
    double findRange() const;

    Matx33d matrix_;
    int kind_;
    Vec<double, 12> k_;  //!< distortion parameters, in COLMAP's order
    double range_;  //!< tangent of the largest angle from the axis at which the distortion is still monotonic
};

//! COLMAP's number of a camera model, -1 for an unknown one.
int modelNumber(const std::string& name);
//! The name of COLMAP's model, or the number itself if it is unknown.
std::string modelName(uint32_t number);
//! Number of a model's parameters; 0 for an unknown model.
size_t parametersOf(const std::string& model);

//! Number of a model's focal lengths, 1 or 2; 0 for an unknown model.
size_t focalsOf(const std::string& model);

}  // namespace cv::iib
