// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#include "matching.hpp"

#include "scene.hpp"
#include "timing.hpp"

#include "opencv2/iib.hpp"

#include <cstdio>

using namespace cv;
using cv::iib::HierarchicalMatcher;
using cv::iib::IIB;

namespace iib_tools {
namespace {

//! One way to match, and on what.
struct Work
{
    Matching::Row row;
    Ptr<DescriptorMatcher> matcher;
};

std::vector<Work> allWork()
{
    const std::vector<int> levels = IIB::create()->levelSizes();
    std::vector<Work> all;
    for (int codes : {100, 500, 1000, 10000})
        for (bool crossCheck : {false, true})
        {
            const auto add = [&](const String& name, const Ptr<DescriptorMatcher>& matcher) {
                all.push_back({{name, codes, crossCheck, DBL_MAX, 0}, matcher});
            };
            const float unused = 0.3f;  // no threshold counts in these modes
            add("EXACT", HierarchicalMatcher::create(levels, HierarchicalMatcher::EXACT, unused, crossCheck));
            if (codes == 10000)
                add("ADAPTIVE", HierarchicalMatcher::create(
                                        levels, HierarchicalMatcher::ADAPTIVE, unused, crossCheck));
            add("BFMatcher", BFMatcher::create(NORM_HAMMING, crossCheck));
        }
    return all;
}

}  // namespace

Matching measureMatching(int rounds)
{
    const Mat image = cornerImage(Size(2560, 1440)), other = relit(image);
    const Ptr<IIB> iib = IIB::create();
    const std::vector<KeyPoint> keypoints = corners(image, 10000);
    CV_Assert(keypoints.size() == 10000);
    const Mat trains = described(iib, image, keypoints), queries = described(iib, other, keypoints);

    setNumThreads(1);
    std::vector<Work> all = allWork();
    std::vector<DMatch> matches;
    // The rounds go through all rows, so that a slow moment of the machine meets them alike; the long ones less often.
    for (int round = 0; round < rounds; round++)
        for (Work& work : all)
        {
            Matching::Row& row = work.row;
            if (row.codes == 10000 && round % 10 != 0)
                continue;
            const Mat from = queries.rowRange(0, row.codes), to = trains.rowRange(0, row.codes);
            const auto run = [&] { work.matcher->match(from, to, matches); };
            if (row.codes < 10000)
                run();  // not timed, as in benchmark.cpp: what the row before left in the caches is no matter of this one
            row.milliseconds = std::min(row.milliseconds, timeOf(run));
            int right = 0;
            for (const DMatch& match : matches)
                right += match.queryIdx == match.trainIdx;
            row.right = double(right) / row.codes;
        }

    Matching result;
    for (const Work& work : all)
        result.rows.push_back(work.row);
    return result;
}

void Matching::print() const
{
    const auto find = [&](const String& name, int codes, bool crossCheck) {
        for (const Row& row : rows)
            if (row.name == name && row.codes == codes && row.crossCheck == crossCheck)
                return row.milliseconds / codes / codes * 1e6;
        return 0.;
    };
    printf("\nMatching codes of 170 bytes with those of the same points in other light, one thread\n\n");
    printf("%-10s %6s %5s %10s %8s %14s %14s %6s\n", "", "codes", "cross", "ms", "ns/pair", "over 10,000's",
            "BFMatcher over", "right");
    for (const Row& row : rows)
    {
        const double perPair = find(row.name, row.codes, row.crossCheck);
        printf("%-10s %6d %5s %10.3f %8.3f %14.2f %14.1f %6.3f\n", row.name.c_str(), row.codes,
                row.crossCheck ? "yes" : "", row.milliseconds, perPair,
                perPair / find(row.name, 10000, row.crossCheck),
                find("BFMatcher", row.codes, row.crossCheck) / perPair, row.right);
    }
}

void Matching::printAgainst(const FileNode& others) const
{
    for (const FileNode& other : others)
        for (const Row& row : rows)
            if (row.name == (String)other["name"] && row.codes == (int)other["codes"] &&
                    row.crossCheck == ((int)other["cross_check"] != 0))
                printf("%-10s %6d %4s %8.2f\n", row.name.c_str(), row.codes, row.crossCheck ? "yes" : "",
                        (double)other["milliseconds"] / row.milliseconds);
}

void Matching::write(FileStorage& fs) const
{
    fs << "matching"
       << "[";
    for (const Row& row : rows)
        fs << "{"
           << "name" << row.name << "codes" << row.codes << "cross_check" << row.crossCheck << "milliseconds"
           << row.milliseconds << "right" << row.right << "}";
    fs << "]";
}

}  // namespace iib_tools
