// SPDX-License-Identifier: Apache-2.0

#include "colmap_model.hpp"

#include <unordered_map>

#include "text_file.hpp"

namespace iib_localization {
namespace {

typedef std::unordered_map<int64_t, int> Indices;

//! Returns where in `points` each id is.
Indices readPoints(const std::string& path, std::vector<Eigen::Vector3d>& points)
{
    Indices indices;
    TextFile file(path);
    while (file.next())
    {
        const int64_t id = file.whole(0, 0, INT64_MAX);
        if (!indices.emplace(id, int(points.size())).second)
            file.fail("a second point " + std::to_string(id));
        points.emplace_back(file.number(1), file.number(2), file.number(3));
    }
    return indices;
}

Keyframe readKeyframe(const TextFile& file, const Cameras& cameras)
{
    if (file.size() != 10)
        file.fail(
                cv::format("%d values, not IMAGE_ID QW QX QY QZ TX TY TZ CAMERA_ID NAME", int(file.size())));
    Keyframe k;
    const Eigen::Quaterniond fromWorld(file.number(1), file.number(2), file.number(3), file.number(4));
    if (std::abs(fromWorld.norm() - 1) > 1e-2)
        file.fail("the quaternion's length is not 1");
    k.pose.rotation = fromWorld.normalized().conjugate();
    k.pose.position = -(k.pose.rotation * Eigen::Vector3d(file.number(5), file.number(6), file.number(7)));
    k.camera = int(file.whole(8, 0, INT_MAX));
    if (cameras.count(k.camera) == 0)
        file.fail("cameras.txt has no camera " + file.word(8));
    k.name = file.word(9);
    return k;
}

void readImages(const std::string& path, const Indices& indices, Model& model)
{
    TextFile file(path);
    while (file.next())
    {
        Keyframe k = readKeyframe(file, model.cameras);
        if (!file.next(TextFile::KEEP) || file.size() % 3 != 0)
            file.fail("no line with X Y POINT3D_ID for each point of " + k.name);
        for (size_t i = 0; i < file.size(); i += 3)
        {
            const int64_t id = file.whole(i + 2, -1, INT64_MAX);
            if (id < 0)
                continue;
            const auto point = indices.find(id);
            if (point == indices.end())
                file.fail("points3D.txt has no point " + file.word(i + 2));
            k.pixels.emplace_back(file.number(i) - 0.5, file.number(i + 1) - 0.5);
            k.points.push_back(point->second);
        }
        model.keyframes.push_back(k);
    }
}

}  // namespace

Model readModel(const std::string& folder)
{
    Model model;
    model.cameras = readCameras(folder + "/cameras.txt");
    const Indices indices = readPoints(folder + "/points3D.txt", model.points);
    readImages(folder + "/images.txt", indices, model);
    return model;
}

void writeModel(const std::string& folder, const Model& model)
{
    writeCameras(folder + "/cameras.txt", model.cameras);

    std::vector<std::string> tracks(model.points.size());
    const std::string images = folder + "/images.txt";
    std::ofstream stream = createFile(images);
    stream << "# IMAGE_ID, QW, QX, QY, QZ, TX, TY, TZ, CAMERA_ID, NAME\n# POINTS2D[] as (X, Y, POINT3D_ID)\n";
    for (size_t i = 0; i < model.keyframes.size(); i++)
    {
        const Keyframe& k = model.keyframes[i];
        const Eigen::Quaterniond q = k.pose.rotation.conjugate();
        const Eigen::Vector3d t = -(q * k.pose.position);
        stream << i + 1;
        for (double v : {q.w(), q.x(), q.y(), q.z(), t.x(), t.y(), t.z()})
            stream << " " << shortest(v);
        stream << " " << k.camera << " " << k.name << "\n";
        for (size_t j = 0; j < k.pixels.size(); j++)
        {
            stream << (j ? " " : "") << shortest(k.pixels[j].x() + 0.5) << " "
                   << shortest(k.pixels[j].y() + 0.5) << " " << k.points[j] + 1;
            tracks[k.points[j]] += " " + std::to_string(i + 1) + " " + std::to_string(j);
        }
        stream << "\n";
    }
    finishFile(stream, images);

    const std::string points = folder + "/points3D.txt";
    stream = createFile(points);
    stream << "# POINT3D_ID, X, Y, Z, R, G, B, ERROR, TRACK[] as (IMAGE_ID, POINT2D_IDX)\n";
    for (size_t i = 0; i < model.points.size(); i++)
    {
        stream << i + 1;
        for (double v : model.points[i])
            stream << " " << shortest(v);
        stream << " 128 128 128 0" << tracks[i] << "\n";
    }
    finishFile(stream, points);
}

}  // namespace iib_localization
