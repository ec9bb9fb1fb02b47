// SPDX-License-Identifier: Apache-2.0

#include "benchmark.hpp"

using namespace cv;
using namespace cv::iib;

namespace iib_tools {
namespace {

//! The descriptors of the same points in a large image and in other light.
struct Codes
{
    explicit Codes(int count)
    {
        const Ptr<IIB> iib = IIB::create();
        trainImage = cornerImage(Size(2560, 1440));
        queryImage = relit(trainImage);
        keypoints = corners(trainImage, count);
        CV_Assert((int)keypoints.size() == count);
        trains = described(iib, trainImage, keypoints);
        queries = described(iib, queryImage, keypoints);
    }

    Mat trainImage, queryImage, trains, queries;
    std::vector<KeyPoint> keypoints;
};

//! One way to match, and on what.
struct Row
{
    String name;
    Ptr<DescriptorMatcher> matcher;
    int codes;
    bool crossCheck;
    double right;  //!< part of the queries that found their own point
};

std::vector<Row> allRows()
{
    const std::vector<int> levels = IIB::create()->levelSizes();
    const float unused = 0.3f;  // no threshold counts in these modes
    std::vector<Row> rows;
    for (int codes : {100, 500, 1000, 10000})
        for (bool crossCheck : {false, true})
        {
            const auto hierarchical = [&](int mode) {
                return HierarchicalMatcher::create(levels, mode, unused, crossCheck);
            };
            rows.push_back({"EXACT", hierarchical(HierarchicalMatcher::EXACT), codes, crossCheck, 0});
            if (codes == 10000)
                rows.push_back(
                        {"ADAPTIVE", hierarchical(HierarchicalMatcher::ADAPTIVE), codes, crossCheck, 0});
            rows.push_back({"BFMatcher", BFMatcher::create(NORM_HAMMING, crossCheck), codes, crossCheck, 0});
        }
    return rows;
}

}  // namespace

void measureMatching(FileStorage& fs, int rounds)
{
    const Codes codes(10000);
    std::vector<Row> rows = allRows();
    std::vector<Timed> tasks;
    std::vector<DMatch> matches;
    for (Row& row : rows)
    {
        const Mat from = codes.queries.rowRange(0, row.codes), to = codes.trains.rowRange(0, row.codes);
        tasks.push_back(
                {[=, &matches] { row.matcher->match(from, to, matches); }, 1, row.codes == 10000 ? 10 : 1});
        tasks.back().run();
        for (const DMatch& match : matches)
            row.right += double(match.queryIdx == match.trainIdx) / row.codes;
    }
    const std::vector<double> milliseconds = measure(tasks, rounds);
    fs << "matching"
       << "[";
    for (size_t i = 0; i < rows.size(); i++)
        fs << "{"
           << "name" << rows[i].name << "codes" << rows[i].codes << "cross_check" << rows[i].crossCheck
           << "milliseconds" << milliseconds[i] << "right" << rows[i].right << "}";
    fs << "]";
}

void measureFrames(FileStorage& fs, int rounds)
{
    const Mat image = cornerImage(Size(640, 480)), next = relit(image);
    const Ptr<ORB> orb = ORB::create(1000);
    std::vector<KeyPoint> keypoints;
    orb->detect(image, keypoints);
    const std::vector<KeyPoint> one(keypoints.begin(), keypoints.begin() + 1);
    const Ptr<IIB> iib = IIB::createFor(orb), upright = IIB::create();
    const Ptr<HierarchicalMatcher> matcher = HierarchicalMatcher::create();
    matcher->setCrossCheck(true);
    const Ptr<BFMatcher> bruteForce = BFMatcher::create(NORM_HAMMING, true);
    const Mat ofOrb = described(orb, image, keypoints), ofIib = described(iib, image, keypoints);
    const Codes many(5000);

    std::vector<DMatch> matches;
    const auto describeMany = [&] { described(upright, many.queryImage, many.keypoints); };
    const auto matchMany = [&] { matcher->match(many.queries, many.trains, matches); };
    const std::vector<double> milliseconds =
            measure({{[&] { bruteForce->match(described(orb, next, keypoints), ofOrb, matches); }, 2, 1},
                            {[&] { matcher->match(described(iib, next, keypoints), ofIib, matches); }, 2, 1},
                            {[&] { described(iib, next, one); }, 1, 1},
                            {[&] { matcher->match(ofIib.row(0), ofIib.row(1), matches); }, 1, 1},
                            {describeMany, 1, 1}, {describeMany, 2, 1}, {matchMany, 1, 1}, {matchMany, 2, 1}},
                    rounds);
    fs << "frames"
       << "{"
       << "orb" << milliseconds[0] << "iib" << milliseconds[1] << "one_keypoint" << milliseconds[2]
       << "one_code" << milliseconds[3] << "describe"
       << "[" << milliseconds[4] << milliseconds[5] << "]"
       << "match"
       << "[" << milliseconds[6] << milliseconds[7] << "]"
       << "}";
}

}  // namespace iib_tools
