// SPDX-License-Identifier: Apache-2.0

#include "line_map.hpp"

#include "text_file.hpp"

namespace iib_localization {

size_t LineMap::bytes() const
{
    size_t sum = lines.size() * sizeof(MapLine);
    for (const MapLine& line : lines)
        sum += line.sights.size() * sizeof(LineSight);
    for (const cv::Mat& c : codes)
        sum += c.total() * c.elemSize();
    return sum;
}

std::vector<std::vector<int>> linesOfKeyframes(const std::vector<MapLine>& lines, size_t keyframes)
{
    std::vector<std::vector<int>> result(keyframes);
    for (size_t i = 0; i < lines.size(); i++)
        for (const LineSight& s : lines[i].sights)
            result[size_t(s.keyframe)].push_back(int(i));
    return result;
}

std::vector<MapLine> readLines(const std::string& path, size_t keyframes)
{
    std::vector<MapLine> lines;
    TextFile file(path);
    while (file.next())
    {
        file.whole(0, int64_t(lines.size()) + 1, int64_t(lines.size()) + 1);
        if (file.size() < 12 || file.size() % 5 != 2)
            file.fail("not LINE3D_ID X1 Y1 Z1 X2 Y2 Z2 and IMAGE_ID U1 V1 U2 V2 of each sight");
        MapLine line = {{file.number(1), file.number(2), file.number(3)},
                {file.number(4), file.number(5), file.number(6)}, {}};
        for (size_t i = 7; i < file.size(); i += 5)
        {
            // COLMAP's pixels have their centres at halves
            const double u1 = file.number(i + 1), v1 = file.number(i + 2), u2 = file.number(i + 3),
                         v2 = file.number(i + 4);
            line.sights.push_back({int(file.whole(i, 1, int64_t(keyframes))) - 1,
                    {{u1 - 0.5, v1 - 0.5}, {u2 - 0.5, v2 - 0.5}}});
        }
        lines.push_back(line);
    }
    return lines;
}

void writeLines(const std::string& path, const std::vector<MapLine>& lines)
{
    std::ofstream stream = createFile(path);
    stream << "# LINE3D_ID, X1, Y1, Z1, X2, Y2, Z2, SIGHTS[] as (IMAGE_ID, U1, V1, U2, V2)\n";
    for (size_t i = 0; i < lines.size(); i++)
    {
        stream << i + 1;
        for (const Eigen::Vector3d& end : {lines[i].begin, lines[i].end})
            for (double v : end)
                stream << " " << shortest(v);
        for (const LineSight& s : lines[i].sights)
        {
            stream << " " << s.keyframe + 1;
            for (const Eigen::Vector2d& end : {s.segment.begin, s.segment.end})
                for (double v : end)
                    stream << " " << shortest(v + 0.5);
        }
        stream << "\n";
    }
    finishFile(stream, path);
}

}  // namespace iib_localization
