// SPDX-License-Identifier: Apache-2.0

// Much at a time, each result compared with one got the easy way. Prints time and memory.

#include "stress.hpp"

#include <atomic>
#include <chrono>
#include <cstdio>
#include <fstream>
#include <thread>

namespace {

using namespace cv;
using cv::iib::HierarchicalMatcher;
using cv::iib::IIB;

//! How much: `small` unless the environment variable IIB_STRESS is set.
int amount(int small, int real) { return std::getenv("IIB_STRESS") ? real : small; }

//! Of this process, in MB: "VmRSS" now, "VmHWM" at its highest.
double memory(const std::string& name)
{
    std::ifstream status("/proc/self/status");
    std::string line;
    while (std::getline(status, line))
        if (line.compare(0, name.size(), name) == 0)
            return std::atof(line.c_str() + name.size() + 1) / 1024;
    return 0;
}

//! Prints the time and memory that the work has taken.
void timed(const std::string& what, const std::function<void()>& work)
{
    const int64 start = getTickCount();
    work();
    std::printf("%s: %.2f s, memory %.0f MB, at its highest %.0f MB\n", what.c_str(),
            (double)(getTickCount() - start) / getTickFrequency(), memory("VmRSS"), memory("VmHWM"));
    std::fflush(stdout);
}

//! Rotated keypoints of sizes 8 to 64.
std::vector<KeyPoint> scatter(Size size, int count)
{
    RNG rng(1);
    std::vector<KeyPoint> keypoints;
    for (int i = 0; i < count; i++)
        keypoints.push_back(KeyPoint(rng.uniform(0.f, (float)size.width),
                rng.uniform(0.f, (float)size.height), rng.uniform(8.f, 64.f), rng.uniform(0.f, 360.f)));
    return keypoints;
}

Ptr<IIB> extractor(bool rotated)
{
    return IIB::create(1.f, 4, IIB::CHANNELS_DEFAULT, IIB::MAPPING_MEAN, false, rotated);
}

//! Descriptors of all the keypoints.
Mat describe(IIB& iib, const Mat& image, std::vector<KeyPoint> keypoints)
{
    Mat descriptors;
    const size_t count = keypoints.size();
    iib.compute(image, keypoints, descriptors);
    EXPECT_TRUE(keypoints.size() == count && descriptors.rows == (int)count) << "a keypoint is lost";
    return descriptors;
}

TEST(Stress, keypoints)
{
    const int count = amount(5000, 1000000);
    const Mat image = noise(Size(1280, 720), CV_8U, 1);
    const std::vector<KeyPoint> keypoints = scatter(image.size(), count);
    for (const bool rotated : {false, true})
    {
        const Ptr<IIB> iib = extractor(rotated);
        Mat descriptors;
        timed(format("%d keypoints on 1280 x 720%s", count, rotated ? ", rotated" : ""),
                [&] { descriptors = describe(*iib, image, keypoints); });
        for (int i = 0; i < 1000; i++)
        {
            const int k = (int)((int64)i * count / 1000);
            ASSERT_TRUE(equal(descriptors.row(k), describe(*iib, image, {keypoints[k]})))
                    << "a keypoint alone is described otherwise";
        }
    }
}

TEST(Stress, pixels)
{
    const Size size(12500, 80 * amount(4, 100));  // so many megapixels
    for (const int type : {CV_8UC1, CV_16UC1, CV_8UC3, CV_32FC1})
        for (const bool rotated : {false, true})
        {
            const Mat image = noise(size, type, 1);
            std::vector<KeyPoint> keypoints = scatter(size - Size(200, 200), 2000);
            keypoints.push_back(
                    KeyPoint((float)size.width / 2, (float)size.height / 2, (float)size.width, 10));
            const Ptr<IIB> iib = extractor(rotated);
            Mat descriptors;
            timed(format("%d x %d, %s%s", size.width, size.height, typeToString(type).c_str(),
                          rotated ? ", rotated" : ""),
                    [&] { descriptors = describe(*iib, image, keypoints); });
            // The steps of 32F depend on the whole image.
            for (int k = 0; k < 2000 && type != CV_32FC1; k += 10)
            {
                KeyPoint kp = keypoints[k];
                const Point corner(std::max((int)kp.pt.x - 150, 0), std::max((int)kp.pt.y - 150, 0));
                const Rect around = Rect(corner, Size(300, 300)) & Rect(Point(), size);
                kp.pt -= Point2f(corner);
                ASSERT_TRUE(equal(descriptors.row(k), describe(*iib, image(around).clone(), {kp})))
                        << "a part of the image is described otherwise";
            }
        }
}

//! They share one extractor and one matcher.
TEST(Stress, threads)
{
    const int seconds = amount(2, 120);
    const Mat image = noise(Size(320, 240), CV_8U, 1);
    const std::vector<KeyPoint> keypoints = scatter(image.size(), 200);
    const Ptr<IIB> iib = extractor(true);
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
    std::this_thread::sleep_for(std::chrono::milliseconds(200 * seconds));
    const double early = memory("VmRSS");
    std::this_thread::sleep_for(std::chrono::milliseconds(800 * seconds));
    const double late = memory("VmRSS");
    stop = true;
    for (std::thread& thread : threads)
        thread.join();
    std::printf("24 threads, %d s: %d rounds, memory %.1f MB after a fifth, %.1f MB at the end\n", seconds,
            (int)rounds, early, late);
    EXPECT_FALSE(wrong) << "a thread got another result than one alone";
    EXPECT_LT(late, early * 1.05 + 16) << "memory grows";
}

}  // namespace
