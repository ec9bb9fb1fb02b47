// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#include "parameters.hpp"

#include "../common/file_numbers.hpp"

namespace cv { namespace iib {

void checkThreshold(float threshold)
{
    require(threshold >= 0 && threshold <= 1, "the threshold", threshold, "0 to 1");
}

void checkLevelSizesGiven(const std::vector<int>& levelSizes)
{
    if (levelSizes.empty())
        CV_Error(Error::StsBadArg,
                "levelSizes is empty: give the bytes of each level, or the descriptor's size");
}

void check(const MatcherParameters& p)
{
    uint64 width = 0;
    for (size_t i = 0; i < p.levelSizes.size(); i++)
    {
        if (p.levelSizes[i] <= 0)
            CV_Error_(Error::StsOutOfRange,
                    ("levelSizes[%d] is %d; each must be above 0", (int)i, p.levelSizes[i]));
        width += p.levelSizes[i];
    }
    if (width > 1 << 20)
        CV_Error(Error::StsOutOfRange, "levelSizes: descriptors of more than 1 MB are not supported");
    require(p.mode >= HierarchicalMatcher::EXACT && p.mode <= HierarchicalMatcher::ADAPTIVE, "mode", p.mode,
            "EXACT, THRESHOLD or ADAPTIVE", Error::StsBadArg);
    if (p.thresholds.size() != p.stages())
        CV_Error_(Error::StsBadArg,
                ("%d thresholds for %d levels: give one for each level but the last, or a single "
                 "one for all",
                        (int)p.thresholds.size(), (int)p.levelSizes.size()));
    for (size_t i = 0; i < p.thresholds.size(); i++)
        checkThreshold(p.thresholds[i]);
    require(p.maxRatio > 0 && p.maxRatio <= 1, "maxRatio", p.maxRatio, "above 0 and at most 1");
}

std::vector<Mat> imagesOf(InputArrayOfArrays descriptors)
{
    std::vector<Mat> images;
    if (descriptors.isMatVector() || descriptors.isUMatVector())
        descriptors.getMatVector(images);
    else
        images.push_back(descriptors.getMat());
    return images;
}

Mat checkedDescriptors(const Mat& descriptors, int width, bool byFirstCodes)
{
    if (descriptors.empty())
        return Mat(0, width, CV_8U);
    if (descriptors.dims != 2 || descriptors.type() != CV_8U)
        CV_Error(Error::StsUnsupportedFormat,
                "Descriptors must be a matrix of type CV_8U (uint8), a row a descriptor, not " +
                        typeToString(descriptors.type()) + "; for floats, as of SIFT, take BFMatcher");
    if (descriptors.cols != width)
        CV_Error_(Error::StsUnmatchedSizes,
                ("Descriptors have %d columns, but %s %d: %s", descriptors.cols,
                        byFirstCodes ? "the first ones had" : "the level sizes add up to", width,
                        byFirstCodes ? "clear() the matcher before it takes others"
                                     : "create the matcher with the level sizes of these descriptors"));
    return descriptors;
}

template <typename T> static std::vector<T> readList(const FileNode& node, const char* key)
{
    // XML has a list of one as a number, and an empty list as an empty node.
    if (!node.isSeq() && node.size() > 0)
        return std::vector<T>(1, numberOf<T>(node, key));
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

MatcherParameters readParameters(const FileNode& node, const char* name, const MatcherParameters& before)
{
    const FileNode fn = nodeNamed(node, name);
    const std::vector<String> keys = fn.isMap() ? fn.keys() : std::vector<String>();
    const auto has = [&](const char* key) { return std::find(keys.begin(), keys.end(), key) != keys.end(); };
    if (!has("levelSizes"))
        CV_Error(Error::StsParseError, String("These are not the parameters of ") + name +
                                               ", which have levelSizes: there is " + describeNode(node));
    MatcherParameters p = before;
    p.levelSizes = readList<int>(fn["levelSizes"], "levelSizes");
    p.thresholds.assign(p.stages(), 0.35f);
    if (has("thresholds"))
        p.thresholds = readList<float>(fn["thresholds"], "thresholds");
    readNumber(fn, "mode", p.mode);
    readNumber(fn, "crossCheck", p.crossCheck);
    readNumber(fn, "maxRatio", p.maxRatio);
    check(p);
    return p;
}

}}  // namespace cv::iib
