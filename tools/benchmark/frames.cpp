// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#include "frames.hpp"

#include "scene.hpp"
#include "timing.hpp"

#include "opencv2/iib.hpp"

#include <cstdio>

using namespace cv;
using namespace cv::iib;

namespace iib_tools {

namespace {

enum
{
    MANY = 5000
};

struct Task
{
    int threads;
    std::function<void()> run;
    double* least;
};

}  // namespace

Frames measureFrames(int rounds)
{
    Frames result;
    const Mat image = cornerImage(Size(640, 480)), next = relit(image);
    const Ptr<ORB> orb = ORB::create(1000);
    std::vector<KeyPoint> keypoints;
    orb->detect(image, keypoints);
    const std::vector<KeyPoint> one(keypoints.begin(), keypoints.begin() + 1);
    const Ptr<IIB> iib = IIB::createFor(orb);
    const Ptr<HierarchicalMatcher> matcher = HierarchicalMatcher::create();
    matcher->setCrossCheck(true);
    const Ptr<BFMatcher> bruteForce = BFMatcher::create(NORM_HAMMING, true);
    const Mat ofOrb = described(orb, image, keypoints), ofIib = described(iib, image, keypoints);

    const Mat large = cornerImage(Size(2560, 1440)), other = relit(large);
    const std::vector<KeyPoint> many = corners(large, MANY);
    const Ptr<IIB> upright = IIB::create();
    const Mat trains = described(upright, large, many), queries = described(upright, other, many);

    std::vector<DMatch> matches;
    std::vector<Task> tasks = {
            {2, [&] { bruteForce->match(described(orb, next, keypoints), ofOrb, matches); }, &result.orb},
            {2, [&] { matcher->match(described(iib, next, keypoints), ofIib, matches); }, &result.iib},
            {1, [&] { described(iib, next, one); }, &result.oneKeypoint},
            {1, [&] { matcher->match(ofIib.row(0), ofIib.row(1), matches); }, &result.oneCode}};
    for (int threads = 1; threads <= 2; threads++)
    {
        tasks.push_back({threads, [&] { described(upright, other, many); }, &result.describe[threads - 1]});
        tasks.push_back(
                {threads, [&] { matcher->match(queries, trains, matches); }, &result.match[threads - 1]});
    }
    for (const Task& task : tasks)
        *task.least = DBL_MAX;
    for (int round = 0; round < rounds; round++)
        for (const Task& task : tasks)
        {
            setNumThreads(task.threads);
            task.run();  // not timed: threads are started and have memory, as in a long run
            *task.least = std::min(*task.least, timeOf(task.run));
        }
    return result;
}

void Frames::print() const
{
    printf("\nA frame of 640 x 480, 1000 points of ORB, described and matched to the last one, two threads:\n"
           "ORB and BFMatcher %.2f ms, IIB and HierarchicalMatcher %.2f ms, ratio %.2f\n",
            orb, iib, iib / orb);
    printf("One of its keypoints described: %.1f us; one code matched with one: %.1f us\n",
            1000 * oneKeypoint, 1000 * oneCode);
    printf("Two threads, %d keypoints of 2560 x 1440: described %.2f times as fast, matched %.2f times\n",
            (int)MANY, describe[0] / describe[1], match[0] / match[1]);
}

void Frames::write(FileStorage& fs) const
{
    fs << "frames"
       << "{"
       << "orb" << orb << "iib" << iib << "one_keypoint" << oneKeypoint << "one_code" << oneCode << "describe"
       << "[" << describe[0] << describe[1] << "]"
       << "match"
       << "[" << match[0] << match[1] << "]"
       << "}";
}

}  // namespace iib_tools
