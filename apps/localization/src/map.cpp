// SPDX-License-Identifier: Apache-2.0

#include "map.hpp"

#include <filesystem>

#include "common/fnv1a.hpp"
#include "opencv2/iib.hpp"
#include "text_file.hpp"

namespace iib_localization {
namespace {

namespace fs = std::filesystem;

const char* const HEADER = "map.txt";
const char* const MAGIC = "iib_localization_map";
constexpr int VERSION = 1;

std::string hashOf(const std::string& path)
{
    std::ifstream stream(path, std::ios::binary);
    if (!stream)
        CV_Error(cv::Error::StsError, path + " is missing: the map is not whole");
    cv::iib::Fnv1a hash;
    std::vector<char> block(1 << 20);
    while (stream.read(block.data(), std::streamsize(block.size())) || stream.gcount() > 0)
        hash.add(block.data(), size_t(stream.gcount()));
    return cv::format("%016llx", (unsigned long long)hash.value());
}

std::string codesFile(size_t detector) { return "codes_" + std::to_string(detector) + ".iib"; }
const char* const LINES = "lines3D.txt";
const char* const LINE_CODES = "codes_lines.iib";

//! @param codes of each keyframe.
void writeCodes(const std::string& path, const std::vector<cv::Mat>& codes)
{
    const cv::Ptr<cv::iib::HierarchicalMatcher> index = cv::iib::HierarchicalMatcher::create();
    index->add(codes);
    index->saveIndex(path);
}

std::vector<cv::Mat> readCodes(const std::string& path, size_t keyframes)
{
    const std::vector<cv::Mat> codes = cv::iib::HierarchicalMatcher::loadIndex(path)->getTrainDescriptors();
    if (codes.size() != keyframes)
        CV_Error(cv::Error::StsError, path + " is not of as many keyframes as images.txt");
    return codes;
}

LineMap readLineMap(const std::string& folder, const Model& model)
{
    LineMap map;
    map.lines = readLines(folder + "/" + LINES, model.keyframes.size());
    map.codes = readCodes(folder + "/" + LINE_CODES, model.keyframes.size());
    const std::vector<std::vector<int>> seen = linesOfKeyframes(map.lines, map.codes.size());
    for (size_t k = 0; k < seen.size(); k++)
        if (map.codes[k].rows != int(seen[k].size()))
            CV_Error(cv::Error::StsError,
                    folder + ": " + model.keyframes[k].name + " has not a code for each line");
    return map;
}

void writeFiles(const std::string& folder, const Map& map)
{
    std::vector<std::string> files = {"cameras.txt", "images.txt", "points3D.txt"};
    writeModel(folder, map.model);
    for (size_t d = 0; d < map.codes.at(0).size(); d++)
    {
        std::vector<cv::Mat> codes;
        for (const std::vector<cv::Mat>& keyframe : map.codes)
            codes.push_back(keyframe[d]);
        files.push_back(codesFile(d));
        writeCodes(folder + "/" + files.back(), codes);
    }
    if (!map.lines.lines.empty())
    {
        files.insert(files.end(), {LINES, LINE_CODES});
        writeLines(folder + "/" + LINES, map.lines.lines);
        writeCodes(folder + "/" + LINE_CODES, map.lines.codes);
    }
    const std::string header = folder + "/" + HEADER;
    std::ofstream stream = createFile(header);
    stream << MAGIC << " " << VERSION << "\nfeatures " << map.features << "\ndescription " << map.description
           << "\n";
    stream << "detectors " << map.codes[0].size() << "\n";
    for (const std::string& file : files)
        stream << "file " << file << " " << hashOf(folder + "/" + file) << "\n";
    finishFile(stream, header);
}

}  // namespace

size_t Map::codeBytes() const
{
    size_t bytes = 0;
    for (const std::vector<cv::Mat>& keyframe : codes)
        for (const cv::Mat& c : keyframe)
            bytes += c.total() * c.elemSize();
    return bytes;
}

size_t Map::pointBytes() const
{
    size_t bytes = model.points.size() * sizeof(model.points[0]);
    for (const Keyframe& k : model.keyframes)
        bytes += k.points.size() * (sizeof(k.points[0]) + sizeof(k.pixels[0]));
    return bytes;
}

NewFolder placeOfMap(const std::string& folder)
{
    return {folder, {HEADER, "cameras.txt", "images.txt", "points3D.txt", LINES, "codes_*.iib"}};
}

void writeMap(NewFolder&& place, const Map& map)
{
    writeFiles(place.path(), map);
    place.publish();
}

Map readMap(const std::string& folder)
{
    if (!fs::exists(fs::path(folder) / HEADER))
        CV_Error(cv::Error::StsError, folder + " is no map: it has no " + HEADER);
    TextFile header(folder + "/" + HEADER);
    if (!header.next() || header.word(0) != MAGIC)
        header.fail("not the header of a map");
    if (header.whole(1, 1, INT_MAX) > VERSION)
        header.fail("the map is of a newer version of this program");
    Map map;
    int64_t detectors = 0;
    bool lines = false;
    while (header.next())
    {
        if (header.word(0) == "features")
            map.features = header.word(1);
        else if (header.word(0) == "description")
            for (size_t i = 1; i < header.size(); i++)
                map.description += (i > 1 ? " " : "") + header.word(i);
        else if (header.word(0) == "detectors")
            detectors = header.whole(1, 1, 16);
        else if (header.word(0) != "file")
            header.fail("'" + header.word(0) + "' is not known");
        else if (hashOf(folder + "/" + header.word(1)) != header.word(2))
            CV_Error(cv::Error::StsError, folder + "/" + header.word(1) + " is damaged: build the map again");
        else
            lines |= header.word(1) == LINES;
    }
    map.model = readModel(folder);
    map.codes.assign(map.model.keyframes.size(), std::vector<cv::Mat>(size_t(detectors)));
    for (size_t d = 0; d < size_t(detectors); d++)
    {
        const std::vector<cv::Mat> codes = readCodes(folder + "/" + codesFile(d), map.codes.size());
        for (size_t k = 0; k < codes.size(); k++)
            map.codes[k][d] = codes[k];
    }
    if (lines)
        map.lines = readLineMap(folder, map.model);
    for (size_t i = 0; i < map.codes.size(); i++)
    {
        size_t rows = 0;
        for (const cv::Mat& c : map.codes[i])
            rows += size_t(c.rows);
        if (rows != map.model.keyframes[i].pixels.size())
            CV_Error(cv::Error::StsError,
                    folder + ": " + map.model.keyframes[i].name + " has not a code for each point");
    }
    return map;
}

}  // namespace iib_localization
