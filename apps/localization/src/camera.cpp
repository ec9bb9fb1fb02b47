// SPDX-License-Identifier: Apache-2.0

#include "camera.hpp"

#include "opencv2/calib3d.hpp"

#include "text_file.hpp"

namespace iib_localization {
namespace {

//! The number of parameters of each model known.
const std::map<std::string, size_t> MODELS = {{"PINHOLE", 4}, {"SIMPLE_RADIAL", 4}, {"OPENCV", 8}};

cv::Matx33d matrix(const Pinhole& p) { return {p.fx, 0, p.cx, 0, p.fy, p.cy, 0, 0, 1}; }

}  // namespace

Pinhole Camera::pinhole() const
{
    const std::vector<double>& p = parameters;
    if (model == "SIMPLE_RADIAL")  // f, cx, cy, k
        return {p[0], p[0], p[1] - 0.5, p[2] - 0.5};
    return {p[0], p[1], p[2] - 0.5, p[3] - 0.5};
}

std::vector<double> Camera::distortion() const
{
    if (model == "SIMPLE_RADIAL")
        return {parameters[3], 0, 0, 0};
    if (model == "OPENCV")
        return {parameters.begin() + 4, parameters.end()};
    return {};
}

std::vector<Eigen::Vector2d> Camera::undistorted(const std::vector<cv::Point2f>& pixels) const
{
    std::vector<cv::Point2f> straight = pixels;
    const cv::Matx33d k = matrix(pinhole());
    if (!distortion().empty() && !pixels.empty())
        cv::undistortPoints(pixels, straight, k, distortion(), cv::noArray(), k);
    std::vector<Eigen::Vector2d> result;
    for (const cv::Point2f& p : straight)
        result.emplace_back(p.x, p.y);
    return result;
}

Eigen::Vector2d Camera::distorted(const Eigen::Vector2d& pixel) const
{
    if (distortion().empty())
        return pixel;
    const Eigen::Vector3d ray = pinhole().ray(pixel);
    std::vector<cv::Point2d> result;
    cv::projectPoints(std::vector<cv::Point3d>{{ray.x(), ray.y(), 1}}, cv::Vec3d(), cv::Vec3d(),
            matrix(pinhole()), distortion(), result);
    return {result[0].x, result[0].y};
}

Cameras readCameras(const std::string& path)
{
    Cameras cameras;
    TextFile file(path);
    while (file.next())
    {
        const int id = int(file.whole(0, 0, INT_MAX));
        Camera camera;
        camera.model = file.word(1);
        const auto known = MODELS.find(camera.model);
        if (known == MODELS.end())
            file.fail("camera model " + camera.model + " is not one of PINHOLE, SIMPLE_RADIAL and OPENCV");
        camera.size = cv::Size(int(file.whole(2, 1, 1 << 16)), int(file.whole(3, 1, 1 << 16)));
        if (file.size() != 4 + known->second)
            file.fail(cv::format("%s has %d parameters, not %d", camera.model.c_str(), int(known->second),
                    int(file.size()) - 4));
        for (size_t i = 4; i < file.size(); i++)
            camera.parameters.push_back(file.number(i));
        if (camera.pinhole().fx <= 0 || camera.pinhole().fy <= 0)
            file.fail("a focal length must be positive");
        if (!cameras.emplace(id, camera).second)
            file.fail("a second camera " + std::to_string(id));
    }
    if (cameras.empty())
        CV_Error(cv::Error::StsParseError, path + " has no camera");
    return cameras;
}

void writeCameras(const std::string& path, const Cameras& cameras)
{
    std::ofstream stream = createFile(path);
    stream << "# CAMERA_ID, MODEL, WIDTH, HEIGHT, PARAMS[]\n";
    for (const auto& [id, camera] : cameras)
    {
        stream << id << " " << camera.model << " " << camera.size.width << " " << camera.size.height;
        for (double p : camera.parameters)
            stream << " " << shortest(p);
        stream << "\n";
    }
    finishFile(stream, path);
}

}  // namespace iib_localization
