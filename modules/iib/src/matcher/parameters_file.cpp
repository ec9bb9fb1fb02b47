// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#include "parameters.hpp"

namespace cv {
namespace iib {

// What a node is, for errors.
static String describe(const FileNode& node)
{
    if (node.empty())
        return "nothing";
    if (node.isString())
        return "the text \"" + (String)node + "\"";
    if (node.isInt())
        return format("the number %d", (int)node);
    if (node.isReal())
        return format("the number %g", (double)node);
    if (node.isSeq())
        return format("a list of %d", (int)node.size());
    String keys;
    for (FileNodeIterator it = node.begin(); it != node.end(); ++it)
        keys += (keys.empty() ? "" : ", ") + (*it).name();
    return "a node with: " + keys;
}

static void failOn(const char* key, const char* expected, const FileNode& found)
{
    CV_Error_(Error::StsParseError,
            ("%s has to be %s, but there is %s", key, expected, describe(found).c_str()));
}

static int readInt(const FileNode& node, const char* key)
{
    if (!node.isInt())
        failOn(key, "a whole number", node);
    return (int)node;
}

static float readFloat(const FileNode& node, const char* key)
{
    if (!node.isReal() && !node.isInt())
        failOn(key, "a number", node);
    return (float)node;
}

static bool readBool(const FileNode& node, const char* key)
{
    if (!node.isInt() || ((int)node != 0 && (int)node != 1))
        failOn(key, "0 or 1", node);
    return (int)node == 1;
}

template <typename T>
static std::vector<T> readList(
        const FileNode& node, const char* key, T (*readOne)(const FileNode&, const char*))
{
    // In XML, a list of one is that number, and an empty list a node without anything.
    if (node.isInt() || node.isReal())
        return std::vector<T>(1, readOne(node, key));
    if (!node.isSeq() && node.size() > 0)
        failOn(key, "a list", node);
    std::vector<T> values;
    for (FileNodeIterator it = node.begin(); it != node.end(); ++it)
        values.push_back(readOne(*it, key));
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
                                               ", which have levelSizes: there is " + describe(node));
    MatcherParameters p = before;
    p.levelSizes = readList(node["levelSizes"], "levelSizes", readInt);
    p.thresholds.assign(p.stages(), 0.35f);
    if (has(node, "thresholds"))
        p.thresholds = readList(node["thresholds"], "thresholds", readFloat);
    if (has(node, "mode"))
        p.mode = readInt(node["mode"], "mode");
    if (has(node, "crossCheck"))
        p.crossCheck = readBool(node["crossCheck"], "crossCheck");
    if (has(node, "maxRatio"))
        p.maxRatio = readFloat(node["maxRatio"], "maxRatio");
    check(p);
    return p;
}

}  // namespace iib
}  // namespace cv
