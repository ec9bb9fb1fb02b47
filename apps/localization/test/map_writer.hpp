// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fstream>

#include "map.hpp"
#include "opencv2/core/quaternion.hpp"
#include "sha256.hpp"

namespace iib_localization {

//! Bytes of numbers, lowest first.
template <typename T> std::string bytes(T value)
{
    return {reinterpret_cast<const char*>(&value), sizeof(value)};
}

//! A file of NumPy's format with an array of bytes.
inline std::string npy(const std::string& shape, const std::string& data)
{
    std::string header = "{'descr': '|u1', 'fortran_order': False, 'shape': (" + shape + "), }";
    header.resize(117, ' ');
    return std::string("\x93NUMPY\x01\0", 8) + bytes(uint16_t(118)) + header + '\n' + data;
}

//! A file of a map, with its sum in the manifest or not.
typedef std::map<std::string, std::string> Files;

//! The files of a map as Python's opencv_iib.localization writes it, but for the manifest. All cameras are PINHOLE.
inline Files filesOf(const Map& map)
{
    Files files;
    std::string &cameras = files["cameras.bin"], &images = files["images.bin"],
                &points = files["points3D.bin"], codes;
    cameras = bytes(uint64_t(map.model.cameras.size()));
    for (const auto& [id, camera] : map.model.cameras)
    {
        cameras += bytes(uint32_t(id)) + bytes(int32_t(1)) + bytes(uint64_t(camera.size.width)) +
                   bytes(uint64_t(camera.size.height));
        for (double p : camera.parameters)
            cameras += bytes(p);
    }
    images = bytes(uint64_t(map.model.images.size()));
    int rows = 0, columns = 1;
    for (const auto& [id, image] : map.model.images)
    {
        const cv::Quatd q = cv::Quatd::createFromRotMat(image.cameraFromWorld.rotation());
        const cv::Vec3d t = image.cameraFromWorld.translation();
        images += bytes(uint32_t(id));
        for (double v : {q.w, q.x, q.y, q.z, t[0], t[1], t[2]})
            images += bytes(v);
        images += bytes(uint32_t(map.model.cameras.begin()->first)) + image.name + '\0' +
                  bytes(uint64_t(image.points.size()));
        for (int64_t point : image.points)
            images += bytes(0.) + bytes(0.) + bytes(point);
        const cv::Mat& c = map.codes.at(id);
        for (int row = 0; row < c.rows; row++)
            codes += std::string(c.ptr<char>(row), size_t(c.cols));
        rows += c.rows;
        columns = c.cols;
    }
    points = bytes(uint64_t(map.model.points.size()));
    for (const auto& [id, p] : map.model.points)
        points += bytes(id) + bytes(p.x) + bytes(p.y) + bytes(p.z) + "rgb" + bytes(0.) + bytes(uint64_t(1)) +
                  bytes(uint64_t(0));
    files["codes.npy"] = npy(cv::format("%d, %d", rows, columns), codes);
    files["misses.npy"] = npy(cv::format("%d,", rows), std::string(size_t(rows), '\0'));
    return files;
}

//! Writes files into a folder, and the manifest of a map with their sums.
inline void writeFiles(const std::string& folder, const Files& files, const Map& map)
{
    std::string images, sums;
    for (const auto& [id, codes] : map.codes)
        images += cv::format("%s[%d, %d, 0]", images.empty() ? "" : ", ", id, codes.rows);
    for (const auto& [name, content] : files)
    {
        std::ofstream(folder + "/" + name, std::ios::binary) << content;
        sums += (sums.empty() ? "\"" : ", \"") + name + "\": \"" + sha256OfFile(folder + "/" + name) + "\"";
    }
    std::ofstream(folder + "/map.json")
            << "{\"format\": 1, \"points\": " << map.points << ", \"updates\": 0, \"images\": [" << images
            << "], \"sha256\": {" << sums << "}}";
}

inline void writeMap(const std::string& folder, const Map& map) { writeFiles(folder, filesOf(map), map); }

}  // namespace iib_localization
