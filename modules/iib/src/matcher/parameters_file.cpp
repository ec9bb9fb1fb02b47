// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#include "../common/file_numbers.hpp"
#include "parameters.hpp"

namespace cv {
namespace iib {

template <typename T> static std::vector<T> readList(const FileNode& node, const char* key)
{
    // In XML, a list of one is that number, and an empty list a node without anything.
    if (node.isInt() || node.isReal())
        return std::vector<T>(1, numberOf<T>(node, key));
    if (!node.isSeq() && node.size() > 0)
        CV_Error(Error::StsParseError,
                String(key) + " is " + describeNode(node) + "; it must be a list of numbers");
    std::vector<T> values;
    for (const FileNode& number : node)
        values.push_back(numberOf<T>(number, key));
    return values;
}

void writeParameters(FileStorage& fs, const MatcherParameters& p)
{
    fs << "levelSizes" << p.levelSizes << "mode" << p.mode << "thresholds" << p.thresholds << "crossCheck"
       << p.crossCheck << "maxRatio" << p.maxRatio;
}

static bool has(const FileNode& node, const String& key)
{
    if (!node.isMap())
        return false;
    const std::vector<String> keys = node.keys();
    return std::find(keys.begin(), keys.end(), key) != keys.end();
}

MatcherParameters readParameters(const FileNode& node, const String& name, const MatcherParameters& before)
{
    if (has(node, name) && !has(node, "levelSizes"))
        return readParameters(node[name], name, before);
    if (!has(node, "levelSizes"))
        CV_Error(Error::StsParseError, "These are not the parameters of " + name +
                                               ", which have levelSizes: there is " + describeNode(node));
    MatcherParameters p = before;
    p.levelSizes = readList<int>(node["levelSizes"], "levelSizes");
    p.thresholds.assign(p.stages(), 0.35f);
    if (has(node, "thresholds"))
        p.thresholds = readList<float>(node["thresholds"], "thresholds");
    readNumber(node, "mode", p.mode);
    readNumber(node, "crossCheck", p.crossCheck);
    readNumber(node, "maxRatio", p.maxRatio);
    check(p);
    return p;
}

}  // namespace iib
}  // namespace cv
