// SPDX-License-Identifier: Apache-2.0

#include "map_builder.hpp"

#include <filesystem>

#include "opencv2/imgcodecs.hpp"

#include "images.hpp"
#include "line_mapping.hpp"
#include "line_tracks.hpp"
#include "pose_check.hpp"
#include "tracks.hpp"
#include "trajectory.hpp"

namespace iib_localization {
namespace {

constexpr double MIN_POSE_AGREEMENT = 0.5;

//! Keyframes with camera and pose, yet without points, and where their images are.
std::vector<ImageFile> findKeyframes(const MapSources& sources, Model& model)
{
    std::vector<ImageFile> images;
    if (std::filesystem::is_directory(sources.poses))
    {
        const Model given = readModel(sources.poses);
        model.cameras = given.cameras;
        for (const ImageFile& image : listImages(sources.images))
            for (const Keyframe& k : given.keyframes)
                if (k.name == image.file)
                {
                    images.push_back(image);
                    model.keyframes.push_back({k.name, k.camera, k.pose, {}, {}});
                }
    }
    else
    {
        model.cameras = readCameras(sources.cameras);
        if (model.cameras.size() != 1)
            CV_Error(cv::Error::StsBadArg, sources.cameras + " has more than one camera: give a COLMAP model "
                                                             "as --poses, which says whose image is whose");
        const std::vector<NamedPose> poses = readTrajectory(sources.poses);
        for (const ImageFile& image : listImages(sources.images))
            if (const Pose* pose = findPose(poses, image.name))
            {
                images.push_back(image);
                model.keyframes.push_back({image.file, model.cameras.begin()->first, *pose, {}, {}});
            }
    }
    if (images.empty())
        CV_Error(cv::Error::StsError, sources.poses + " has no pose for any image in " + sources.images);
    return images;
}

cv::Mat readKeyframe(const ImageFile& image, const Camera& camera)
{
    const cv::Mat grey = cv::imread(image.path, cv::IMREAD_GRAYSCALE);
    if (grey.empty())
        CV_Error(cv::Error::StsError, image.path + " cannot be read as an image");
    if (grey.size() != camera.size)
        CV_Error(cv::Error::StsError,
                cv::format("%s has %d x %d pixels, its camera %d x %d", image.path.c_str(), grey.cols,
                        grey.rows, camera.size.width, camera.size.height));
    return grey;
}

cv::Mat readDepth(const std::string& folder, const ImageFile& image, cv::Size size)
{
    const std::string path = folder + "/" + image.name + ".png";
    const cv::Mat depth = cv::imread(path, cv::IMREAD_UNCHANGED);
    if (depth.type() != CV_16UC1 || depth.size() != size)
        CV_Error(cv::Error::StsError, path + " is no 16-bit depth of the image's size");
    return depth;
}

//! Adds to the map what of a keyframe's features has a point (not negative), with its codes.
void addSights(Map& map, Keyframe& keyframe, const Features& features, const std::vector<int>& points)
{
    std::vector<cv::Mat> codes;
    size_t i = 0;
    for (const cv::Mat& all : features.codes)
    {
        cv::Mat kept(0, all.cols, CV_8U);
        for (int row = 0; row < all.rows; row++, i++)
            if (points[i] >= 0)
            {
                kept.push_back(all.row(row));
                keyframe.pixels.emplace_back(features.pixels[i].x, features.pixels[i].y);
                keyframe.points.push_back(points[i]);
            }
        codes.push_back(kept);
    }
    map.codes.push_back(codes);
}

}  // namespace

double depthAt(const cv::Mat& millimetres, const cv::Point2f& pixel)
{
    const int x = int(std::floor(pixel.x)), y = int(std::floor(pixel.y));
    if (x < 1 || y < 1 || x + 2 >= millimetres.cols || y + 2 >= millimetres.rows)
        return 0;
    double least, most;
    cv::minMaxLoc(millimetres(cv::Rect(x - 1, y - 1, 4, 4)), &least, &most);
    if (least == 0 || most > 1.1 * least)
        return 0;
    // inverse depth is linear on a plane
    const double u = pixel.x - x, v = pixel.y - y;
    const auto inverse = [&](int dy, int dx) { return 1000. / millimetres.at<ushort>(y + dy, x + dx); };
    return 1 / ((1 - v) * ((1 - u) * inverse(0, 0) + u * inverse(0, 1)) +
                       v * ((1 - u) * inverse(1, 0) + u * inverse(1, 1)));
}

Map buildMap(const MapSources& sources)
{
    const FeatureMethod method(sources.features);
    Map map;
    map.features = method.name();
    map.description = method.description();
    const std::vector<ImageFile> images = findKeyframes(sources, map.model);
    std::vector<Features> features;
    std::vector<LineFeatures> lines;
    std::vector<std::vector<int>> points;  // of each feature of each keyframe; -1: none
    for (size_t k = 0; k < images.size(); k++)
    {
        const Keyframe& keyframe = map.model.keyframes[k];
        const Camera& camera = map.model.cameras.at(keyframe.camera);
        const cv::Mat grey = readKeyframe(images[k], camera);
        features.push_back(method.extract(grey));
        lines.push_back(extractLines(grey));
        points.emplace_back(features[k].pixels.size(), -1);
        if (sources.depth.empty())
            continue;
        const cv::Mat depth = readDepth(sources.depth, images[k], camera.size);
        const std::vector<Eigen::Vector2d> straight = camera.undistorted(features[k].pixels);
        for (size_t i = 0; i < straight.size(); i++)
            if (const double z = depthAt(depth, features[k].pixels[i]))
            {
                points[k][i] = int(map.model.points.size());
                map.model.points.push_back(keyframe.pose.toWorld(camera.pinhole().ray(straight[i]) * z));
            }
        addLinesFromDepth(map.lines, lines[k], camera, keyframe.pose, depth);
    }
    if (poseAgreement(method, features, map.model) < MIN_POSE_AGREEMENT)
        CV_Error(cv::Error::StsError,
                sources.poses + " does not fit the images in " + sources.images +
                        ": are the poses those of these images, and is the camera right?");
    if (sources.depth.empty())
    {
        points = triangulateTracks(method, features, sources.refinePoses, map.model);
        map.lines = triangulateLines(lines, map.model);
    }
    for (size_t k = 0; k < images.size(); k++)
        addSights(map, map.model.keyframes[k], features[k], points[k]);
    if (map.model.points.size() < 10)
        CV_Error(cv::Error::StsError,
                cv::format("only %d points could be placed: are the poses and the camera right?",
                        int(map.model.points.size())));
    return map;
}

}  // namespace iib_localization
