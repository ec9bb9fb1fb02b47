// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>

#include "opencv2/iib/localization.hpp"

namespace iib_localization {

using cv::iib::Camera;

//! What a camera does to rays. The centre of the first pixel is (0, 0), here and everywhere but in COLMAP's files.
class Lens
{
public:
    //! @throws cv::Exception for invalid parameters, and for an unknown model, which it names.
    explicit Lens(const Camera& camera);

    //! Of a camera without distortion that undistorted() gives the pixels of.
    const cv::Matx33d& matrix() const { return matrix_; }
    //! NaN for pixels that no point before the camera is seen at.
    std::vector<cv::Point2d> undistorted(const std::vector<cv::Point2d>& pixels) const;
    /** Where points in the camera's axes are seen; NaN behind it.
    @param jacobians if not null: of the pixels by the points. */
    std::vector<cv::Point2d> project(
            const std::vector<cv::Point3d>& points, std::vector<cv::Matx23d>* jacobians = nullptr) const;

private:
    cv::Vec2d distorted(const cv::Vec2d& ray) const;
    cv::Matx22d slope(const cv::Vec2d& ray) const;

    cv::Matx33d matrix_;
    int kind_;
    cv::Vec<double, 12> k_;  //!< parameters of the distortion, in COLMAP's order
};

//! Of a camera among others; how many there are, if it is not there.
inline size_t indexOf(const Camera& camera, const std::vector<Camera>& cameras)
{
    return size_t(std::find_if(cameras.begin(), cameras.end(), [&](const Camera& other) {
        return camera.model == other.model && camera.size == other.size &&
               camera.parameters == other.parameters;
    }) - cameras.begin());
}

//! The camera of an image that was reduced to a size by a scale.
Camera scaled(const Camera& camera, double scale, const cv::Size& size);

//! COLMAP's number of a camera model, or -1; of a number its name, or the number.
int modelNumber(const std::string& name);
std::string modelName(uint32_t number);
//! How many parameters a model has; 0 for an unknown one.
size_t parametersOf(const std::string& model);

}  // namespace iib_localization
