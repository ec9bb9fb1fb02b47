// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

// Large inputs, compared with small ones; minutes and gigabytes, with --test_tag_enable=verylong.

#include "support/describe.hpp"

#include <atomic>
#include <chrono>
#include <fstream>
#include <thread>

namespace opencv_test { namespace {

Mat noise(Size size, int type)
{
    Mat image(size, type);
    RNG(1).fill(image, RNG::UNIFORM, 0, CV_MAT_DEPTH(type) == CV_8U ? 256 : 65536);
    return image;
}

Ptr<IIB> extractor(bool rotated)
{
    return IIB::create(1.f, 4, IIB::CHANNELS_DEFAULT, IIB::MAPPING_MEAN, false, rotated);
}

TEST(IIB_Stress, a_million_keypoints)
{
    applyTestTag(CV_TEST_TAG_VERYLONG);
    const int count = 1000000;
    const Mat image = noise(Size(1280, 720), CV_8U);
    const std::vector<KeyPoint> keypoints = scatter(image.size(), count, 8, 64, 1);
    for (bool rotated : {false, true})
    {
        const Ptr<IIB> iib = extractor(rotated);
        const Mat descriptors = describe(*iib, image, keypoints);
        for (int k = 0; k < count; k += 1000)
            ASSERT_EQ(0, differingBits(descriptors.row(k), describe(*iib, image, {keypoints[k]}))) << k;
    }
}

TEST(IIB_Stress, a_hundred_megapixels)
{
    applyTestTag(CV_TEST_TAG_VERYLONG);
    const Size size(12500, 8000);
    for (int type : {CV_8UC1, CV_16UC1, CV_8UC3, CV_32FC1})
        for (bool rotated : {false, true})
        {
            const Mat image = noise(size, type);
            std::vector<KeyPoint> keypoints = scatter(size, 2000, 8, 64, 1);
            keypoints.push_back(KeyPoint(size.width / 2.f, size.height / 2.f, (float)size.width, 10));
            const Ptr<IIB> iib = extractor(rotated);
            const Mat descriptors = describe(*iib, image, keypoints);
            for (int k = 0; k < 2000 && type != CV_32FC1;
                    k += 10)  // the steps of 32F depend on the whole image
            {
                KeyPoint kp = keypoints[k];
                const Point corner(cvFloor(kp.pt.x) - 150, cvFloor(kp.pt.y) - 150);
                const Rect around = Rect(corner, Size(300, 300)) & Rect(Point(), size);
                if (around.size() != Size(300, 300))
                    continue;  // the region ends at the image's border
                kp.pt -= Point2f(corner);
                ASSERT_EQ(0, differingBits(descriptors.row(k), describe(*iib, image(around).clone(), {kp})))
                        << k;
            }
        }
}

//! Pages of this process; 0 if unknown.
long residentPages()
{
    long all = 0, resident = 0;
    std::ifstream("/proc/self/statm") >> all >> resident;
    return resident;
}

TEST(IIB_Stress, two_minutes_of_24_threads_that_share_all)
{
    applyTestTag(CV_TEST_TAG_VERYLONG);
    const Mat image = noise(Size(320, 240), CV_8U);
    const std::vector<KeyPoint> keypoints = scatter(image.size(), 200, 8, 64, 1);
    const Ptr<IIB> iib = extractor(true);
    const Ptr<HierarchicalMatcher> matcher =
            HierarchicalMatcher::create(iib->levelSizes(), HierarchicalMatcher::EXACT, 0.35f, true);
    const Mat expected = describe(*iib, image, keypoints);
    matcher->add(expected);
    Mat indices, distances;
    matcher->knnMatchArrays(expected, indices, distances, 3);
    std::atomic<bool> stop(false), wrong(false);
    std::vector<std::thread> threads;
    for (int i = 0; i < 24; i++)
        threads.push_back(std::thread([&] {
            while (!stop)
            {
                std::vector<KeyPoint> k = keypoints;
                Mat descriptors, i2, d2;
                iib->compute(image, k, descriptors);
                matcher->knnMatchArrays(descriptors, i2, d2, 3);
                if (cvtest::norm(expected, descriptors, NORM_INF) + cvtest::norm(indices, i2, NORM_INF) +
                                cvtest::norm(distances, d2, NORM_INF) !=
                        0)
                    wrong = true;
            }
        }));
    std::this_thread::sleep_for(std::chrono::seconds(24));
    const long early = residentPages();
    std::this_thread::sleep_for(std::chrono::seconds(96));
    const long late = residentPages();
    stop = true;
    for (std::thread& thread : threads)
        thread.join();
    EXPECT_FALSE(wrong) << "a thread got another result than one alone";
    EXPECT_LT(late, early * 1.05 + 4096) << "memory grows";
}

}}  // namespace opencv_test
