// SPDX-License-Identifier: Apache-2.0

#include "precomp.hpp"

#include "lens.hpp"

#include <algorithm>
#include <limits>
#include <map>

#include "numbers.hpp"

namespace iib_localization {
namespace {

const std::map<std::string, size_t> MODELS = {{"SIMPLE_PINHOLE", 3}, {"PINHOLE", 4}, {"SIMPLE_RADIAL", 4},
        {"RADIAL", 5}, {"OPENCV", 8}, {"OPENCV_FISHEYE", 8}};  // and how many parameters they have

[[noreturn]] void fail(const std::string& what) { CV_Error(cv::Error::StsBadArg, what); }

//! Models with one focal length for both axes.
bool isSimple(const std::string& model)
{
    return model == "SIMPLE_PINHOLE" || model == "SIMPLE_RADIAL" || model == "RADIAL";
}

const Camera& checked(const Camera& camera)
{
    const auto model = MODELS.find(camera.model);
    const std::vector<double>& p = camera.parameters;
    if (model == MODELS.end())
        fail("camera model " + camera.model +
                " is not one of SIMPLE_PINHOLE, PINHOLE, SIMPLE_RADIAL, RADIAL, OPENCV and OPENCV_FISHEYE");
    if (p.size() != model->second)
        fail(cv::format("camera model %s has %d parameters, not %d", camera.model.c_str(), int(model->second),
                int(p.size())));
    if (camera.size.empty() || !(p[0] > 0) || !(isSimple(camera.model) || p[1] > 0))
        fail("a camera's size and focal length must be positive");
    return camera;
}

}  // namespace

Lens::Lens(const Camera& camera)
{
    const std::vector<double>& p = checked(camera).parameters;
    const bool simple = isSimple(camera.model);
    const size_t centre = simple ? 1 : 2;
    fisheye_ = camera.model == "OPENCV_FISHEYE";
    matrix_ = {p[0], 0, p[centre] - .5, 0, p[simple ? 0 : 1], p[centre + 1] - .5, 0, 0, 1};
    distortion_.assign(p.begin() + std::ptrdiff_t(centre + 2), p.end());
    if (!distortion_.empty())
        distortion_.resize(4, 0);  // k1, k2, p1, p2, or of a fisheye k1 to k4
}

std::vector<cv::Point2d> Lens::undistorted(const std::vector<cv::Point2d>& pixels) const
{
    if (distortion_.empty() || pixels.empty())
        return pixels;
    std::vector<cv::Point2d> straight;
    if (fisheye_)
        cv::fisheye::undistortPoints(pixels, straight, matrix_, distortion_, cv::noArray(), matrix_);
    else
        cv::undistortPoints(pixels, straight, matrix_, distortion_, cv::noArray(), matrix_,
                cv::TermCriteria(cv::TermCriteria::COUNT + cv::TermCriteria::EPS, 50, 1e-3));
    return straight;
}

std::vector<cv::Point2d> Lens::project(const std::vector<cv::Point3d>& points, cv::Mat* jacobian) const
{
    std::vector<cv::Point2d> pixels;
    if (points.empty())
        return pixels;
    cv::Mat all;
    const cv::_OutputArray wanted = jacobian ? cv::_OutputArray(all) : cv::_OutputArray();
    if (fisheye_)
        cv::fisheye::projectPoints(points, pixels, cv::Vec3d(), cv::Vec3d(), matrix_, distortion_, 0, wanted);
    else
        cv::projectPoints(points, cv::Vec3d(), cv::Vec3d(), matrix_, distortion_, pixels, wanted);
    if (jacobian)  // by the translation
        *jacobian = all.colRange(fisheye_ ? 11 : 3, fisheye_ ? 14 : 6).clone();
    for (size_t i = 0; i < points.size(); i++)
        if (!(points[i].z > 0))
            pixels[i].x = pixels[i].y = std::numeric_limits<double>::quiet_NaN();
    return pixels;
}

}  // namespace iib_localization

cv::iib::Camera cv::iib::Camera::parse(const std::string& text)
{
    const size_t comma = std::min(text.find(','), text.size() - 1);
    const std::vector<double> values = iib_localization::numbersOf(text.substr(comma + 1));
    if (values.size() < 3 || std::max(std::abs(values[0]), std::abs(values[1])) >= 1 << 16)
        CV_Error(Error::StsBadArg, "camera " + text + " is not MODEL,WIDTH,HEIGHT,PARAMETERS");
    return iib_localization::checked({text.substr(0, comma), Size(int(values[0]), int(values[1])),
            std::vector<double>(values.begin() + 2, values.end())});
}
