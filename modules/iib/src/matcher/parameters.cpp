// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#include "parameters.hpp"
#include "opencv2/iib.hpp"

namespace cv {
namespace iib {

void checkThreshold(float threshold)
{
    if (!(threshold >= 0 && threshold <= 1))
        CV_Error_(Error::StsOutOfRange, ("the threshold is %g: it has to be 0 to 1", threshold));
}

void check(const MatcherParameters& p)
{
    if (p.levelSizes.empty())
        CV_Error(Error::StsBadArg,
                "levelSizes is empty: give the bytes of each level, or the descriptor's size");
    uint64 width = 0;
    for (size_t i = 0; i < p.levelSizes.size(); i++)
    {
        if (p.levelSizes[i] <= 0)
            CV_Error_(Error::StsOutOfRange,
                    ("levelSizes[%d] is %d: each has to be > 0", (int)i, p.levelSizes[i]));
        width += p.levelSizes[i];
    }
    if (width > 1 << 20)
        CV_Error(Error::StsOutOfRange, "levelSizes: descriptors of more than 1 MB are not supported");
    if (p.mode != HierarchicalMatcher::EXACT && p.mode != HierarchicalMatcher::THRESHOLD &&
            p.mode != HierarchicalMatcher::ADAPTIVE)
        CV_Error_(Error::StsBadArg, ("mode is %d: use EXACT, THRESHOLD or ADAPTIVE", p.mode));
    if (p.thresholds.size() + 1 != p.levelSizes.size())
        CV_Error_(Error::StsBadArg,
                ("%d thresholds for %d levels: give one for each level but the last, or a single "
                 "one for all",
                        (int)p.thresholds.size(), (int)p.levelSizes.size()));
    for (size_t i = 0; i < p.thresholds.size(); i++)
        checkThreshold(p.thresholds[i]);
    if (!(p.maxRatio > 0 && p.maxRatio <= 1))
        CV_Error_(Error::StsOutOfRange, ("maxRatio is %g: it has to be above 0 and at most 1", p.maxRatio));
}

void writeParameters(FileStorage& fs, const MatcherParameters& p)
{
    fs << "levelSizes" << p.levelSizes << "mode" << p.mode << "thresholds" << p.thresholds << "crossCheck"
       << p.crossCheck << "maxRatio" << p.maxRatio;
}

MatcherParameters readParameters(const FileNode& node, const MatcherParameters& before)
{
    MatcherParameters p = before;
    if (!node["levelSizes"].empty())
    {
        node["levelSizes"] >> p.levelSizes;
        p.thresholds.assign(std::max(p.levelSizes.size(), (size_t)1) - 1, 0.35f);
    }
    cv::read(node["mode"], p.mode, p.mode);
    if (!node["thresholds"].empty())
        node["thresholds"] >> p.thresholds;
    cv::read(node["crossCheck"], p.crossCheck, p.crossCheck);
    cv::read(node["maxRatio"], p.maxRatio, p.maxRatio);
    check(p);
    return p;
}

}  // namespace iib
}  // namespace cv
