// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#include "stress.hpp"

#include <atomic>
#include <chrono>
#include <cstdio>
#include <thread>

namespace iib_stress {

using namespace cv;
using cv::iib::HierarchicalMatcher;
using cv::iib::IIB;

static int distance(const uchar* a, const uchar* b, int bytes)
{
    int sum = 0;
    for (int i = 0; i < bytes; i++)
        for (int bits = a[i] ^ b[i]; bits; bits &= bits - 1)
            sum++;
    return sum;
}

void manyCodes(int count)
{
    const Mat train = noise(Size(170, count), CV_8U, 1);
    Mat queries = noise(Size(170, 20), CV_8U, 2);
    train.row(count - 1).copyTo(queries.row(7));
    const Ptr<HierarchicalMatcher> matcher = HierarchicalMatcher::create({2, 8, 32, 128});
    {
        const Report report(format("%d train descriptors added", count));
        matcher->add(train);
    }
    std::vector<DMatch> matches;
    {
        const Report report(format("%d queries against them", queries.rows));
        matcher->match(queries, matches);
    }
    require(matches[7].distance == 0 && matches[7].trainIdx == count - 1, "a copy is not found");
    for (const DMatch& m : matches)
        for (int t = 0; t < count; t++)
        {
            const int d = m.queryIdx % 5 ? (int)m.distance
                                         : distance(queries.ptr(m.queryIdx), train.ptr(t), train.cols);
            require(d > m.distance || (d == m.distance && (m.queryIdx % 5 || t >= m.trainIdx)),
                    "a nearer one is missed");
        }
}

void manyThreads(int seconds)
{
    const Mat image = noise(Size(320, 240), CV_8U, 1);
    const std::vector<KeyPoint> keypoints = scatter(image.size(), 200);
    const Ptr<IIB> iib = IIB::create(1.f, 4, IIB::CHANNELS_DEFAULT, IIB::MAPPING_MEAN, false, true);
    const Ptr<HierarchicalMatcher> matcher =
            HierarchicalMatcher::create(iib->levelSizes(), HierarchicalMatcher::EXACT, 0.35f, true);
    setNumThreads(1);
    const Mat expected = describe(*iib, image, keypoints);
    matcher->add(expected);
    Mat indices, distances;
    matcher->knnMatchArrays(expected, indices, distances, 3);
    setNumThreads(-1);

    std::atomic<bool> stop(false), wrong(false);
    std::atomic<int> rounds(0);
    std::vector<std::thread> threads;
    for (int i = 0; i < 24; i++)
        threads.push_back(std::thread([&] {
            while (!stop)
            {
                Mat i2, d2;
                const Mat descriptors = describe(*iib, image, keypoints);
                matcher->knnMatchArrays(descriptors, i2, d2, 3);
                if (!equal(expected, descriptors) || !equal(indices, i2) || !equal(distances, d2))
                    wrong = true;
                rounds++;
            }
        }));
    double early = 0;
    for (int s = 0; s < seconds; s++)
    {
        std::this_thread::sleep_for(std::chrono::seconds(1));
        if (s == seconds / 5)
            early = memory("VmRSS");
    }
    const double late = memory("VmRSS");
    stop = true;
    for (std::thread& thread : threads)
        thread.join();
    std::printf("24 threads, %d s: %d rounds, memory %.1f MB after a fifth, %.1f MB at the end\n", seconds,
            (int)rounds, early, late);
    require(!wrong, "a thread got another result than one alone");
    require(late < early * 1.05 + 16, "memory grows");
}

}  // namespace iib_stress
