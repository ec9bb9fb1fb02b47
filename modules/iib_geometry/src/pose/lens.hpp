// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "opencv2/iib/localization.hpp"

namespace cv::iib {

//! What a camera does to rays. The centre of the first pixel is (0, 0), here and everywhere but in COLMAP's files.
class Lens
{
public:
    //! @throws cv::Exception for invalid parameters, and for an unknown model, which it names.
    explicit Lens(const Camera& camera);

    //! The matrix of the camera without distortion whose pixels undistorted() gives.
    const Matx33d& matrix() const { return matrix_; }
    //! As Camera::undistorted has it.
    std::vector<Point2d> undistorted(const std::vector<Point2d>& pixels) const;
    /** Where points in the camera's axes are seen; NaN behind it and beyond what the lens shows.
    @param jacobians if not null: of the pixels by the points. */
    std::vector<Point2d> project(
            const std::vector<Point3d>& points, std::vector<Matx23d>* jacobians = nullptr) const;

private:
    Vec2d distorted(const Vec2d& ray) const;
    Matx22d slope(const Vec2d& ray) const;
    double findRange() const;

    Matx33d matrix_;
    int kind_;
    Vec<double, 12> k_;  //!< parameters of the distortion, in COLMAP's order
    double range_;       //!< tangent of the angle from the axis, up to which pixels of rays move outwards
};

//! COLMAP's number of a camera model, or -1; of a number its name, or the number.
int modelNumber(const std::string& name);
std::string modelName(uint32_t number);
//! How many parameters a model has; 0 for an unknown one.
size_t parametersOf(const std::string& model);

//! How many of a model's parameters are focal lengths, 1 or 2; 0 if it is none.
size_t focalsOf(const std::string& model);

}  // namespace cv::iib
