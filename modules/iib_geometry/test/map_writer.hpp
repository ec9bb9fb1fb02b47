// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fstream>
#include <map>

#include "map.hpp"
#include "npy.hpp"

namespace iib_localization {

//! A file of NumPy's format with a continuous array.
inline std::string npy(const cv::Mat& array)
{
    const std::string shape = cv::format(array.cols == 1 ? "%d," : "%d, %d", array.rows, array.cols);
    std::string header = "{'descr': '" +
                         std::string(array.depth() == CV_8U    ? "|u1"
                                     : array.depth() == CV_32S ? "<i4"
                                                               : "<f8") +
                         "', 'fortran_order': False, 'shape': (" + shape + "), }";
    header.resize(117, ' ');
    return std::string("\x93NUMPY\x01\0\x76\0", 10) + header + '\n' +
           std::string(array.ptr<char>(), array.total() * array.elemSize());
}

//! Files of a map and what is in them.
typedef std::map<std::string, std::string> Files;

//! The files of a map as Python's opencv_iib.localization writes it, but for the manifest.
inline Files filesOf(const Map& map)
{
    cv::Mat views;
    for (const View& v : map.views)
        views.push_back(cv::Mat(cv::Matx<double, 1, 7>(v.centre[0], v.centre[1], v.centre[2], v.direction[0],
                v.direction[1], v.direction[2], v.depth)));
    return {{"codes.npy", npy(map.codes)}, {"sees.npy", npy(map.sees)}, {"points.npy", npy(map.points)},
            {"views.npy", npy(views)}};
}

//! Writes files into a folder, and the manifest of a map with their sums.
inline void writeFiles(const std::string& folder, const Files& files, const Map& map)
{
    std::string images, cameras, sums;
    const auto separated = [](std::string& list) -> std::string& { return list += list.empty() ? "" : ", "; };
    for (const View& v : map.views)
        separated(images) += cv::format("[1, %d, 0]", v.rows.size());
    for (const auto& c : map.cameras)
    {
        separated(cameras) += cv::format("[\"%s\", %d, %d, [", c.model.c_str(), c.size.width, c.size.height);
        for (size_t i = 0; i < c.parameters.size(); i++)
            cameras += cv::format(i ? ", %.17g" : "%.17g", c.parameters[i]);
        cameras += "]]";
    }
    for (const auto& [name, content] : files)
    {
        std::ofstream(folder + "/" + name, std::ios::binary) << content;
        separated(sums) +=
                cv::format("\"%s\": \"%08x\"", name.c_str(), crc32(content.data(), content.size()));
    }
    std::ofstream(folder + "/map.json")
            << "{\"format\": 2, \"points\": " << map.keypoints << ", \"updates\": 0, \"images\": [" << images
            << "], \"cameras\": [" << cameras << "], \"crc32\": {" << sums << "}}";
}

inline void writeMap(const std::string& folder, const Map& map) { writeFiles(folder, filesOf(map), map); }

}  // namespace iib_localization
