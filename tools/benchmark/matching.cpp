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

Timed matching(const Ptr<DescriptorMatcher>& matcher, const String& name, bool crossCheck, const Codes& codes,
        int count, int threads = 1)
{
    const Mat from = codes.queries.rowRange(0, count), to = codes.trains.rowRange(0, count);
    std::vector<DMatch> matches;
    return {crossCheck ? "cross-check" : "match", name, double(count), threads, count == 10000 ? 10 : 1,
            [=]() mutable { matcher->match(from, to, matches); }};
}

}  // namespace

std::vector<Timed> matchingTasks()
{
    const Codes codes(10000);
    const std::vector<int> levels = IIB::create()->levelSizes();
    const float unused = 0.3f;  // no threshold counts in these modes
    std::vector<Timed> tasks;
    for (int count : {100, 500, 1000, 10000})
        for (bool crossCheck : {false, true})
        {
            const auto add = [&](const String& name, const Ptr<DescriptorMatcher>& matcher) {
                tasks.push_back(matching(matcher, name, crossCheck, codes, count));
            };
            add("EXACT", HierarchicalMatcher::create(levels, HierarchicalMatcher::EXACT, unused, crossCheck));
            if (count == 10000)
                add("ADAPTIVE", HierarchicalMatcher::create(
                                        levels, HierarchicalMatcher::ADAPTIVE, unused, crossCheck));
            add("BFMatcher", BFMatcher::create(NORM_HAMMING, crossCheck));
        }
    return tasks;
}

std::vector<Timed> frameTasks()
{
    const Mat image = cornerImage(Size(640, 480)), next = relit(image);
    const Ptr<ORB> orb = ORB::create(1000);
    std::vector<KeyPoint> keypoints;
    orb->detect(image, keypoints);
    const std::vector<KeyPoint> one(keypoints.begin(), keypoints.begin() + 1);
    const Ptr<IIB> iib = IIB::createFor(orb);
    const Ptr<HierarchicalMatcher> matcher = HierarchicalMatcher::create();
    matcher->setCrossCheck(true);
    const Codes many(5000);
    const auto frame = [&](const String& name, const Ptr<Feature2D>& feature,
                               const Ptr<DescriptorMatcher>& by) {
        const Mat before = described(feature, image, keypoints);
        return Timed{"frame", name, 1000, 2, 1, [=] {
                         std::vector<DMatch> matches;
                         by->match(described(feature, next, keypoints), before, matches);
                     }};
    };
    const auto matchingOf = [&](const String& name, int count, int threads) {
        Timed task = matching(matcher, name, true, many, count, threads);
        task.what = "frame";
        return task;
    };
    std::vector<Timed> tasks = {frame("ORB and BFMatcher", orb, BFMatcher::create(NORM_HAMMING, true)),
            frame("default and EXACT", iib, matcher), describing("frame", "one point", 1, iib, next, one),
            matchingOf("one code", 1, 1)};
    for (int threads : {1, 2})
    {
        tasks.push_back(describing(
                "frame", "5000 points", 5000, IIB::create(), many.queryImage, many.keypoints, threads));
        tasks.push_back(matchingOf("5000 codes", 5000, threads));
    }
    return tasks;
}

}  // namespace iib_tools
