// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

// The library under stress, each result compared with one got the easy way:
//   iib_stress keypoints [COUNT]   many keypoints on one image
//   iib_stress codes [COUNT]       many train descriptors
//   iib_stress pixels [MEGAPIXELS] large images of every type
//   iib_stress threads [SECONDS]   24 threads that share one extractor and one matcher
// Prints time and memory; exit code 1 and a line for what does not hold.

#include "stress.hpp"

#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <stdexcept>

namespace iib_stress {

using namespace cv;
using cv::iib::IIB;

void require(bool condition, const char* what)
{
    if (!condition)
        throw std::logic_error(what);
}

double memory(const std::string& name)
{
    std::ifstream status("/proc/self/status");
    std::string line;
    while (std::getline(status, line))
        if (line.compare(0, name.size(), name) == 0)
            return std::atof(line.c_str() + name.size() + 1) / 1024;
    return 0;
}

Report::~Report()
{
    std::printf("%s: %.2f s, memory %.0f MB, at its highest %.0f MB\n", what.c_str(),
            (double)(cv::getTickCount() - start) / cv::getTickFrequency(), memory("VmRSS"), memory("VmHWM"));
    std::fflush(stdout);
}

Mat noise(Size size, int type, int seed)
{
    Mat image(size, type);
    RNG rng(seed);
    rng.fill(image, RNG::UNIFORM, 0, CV_MAT_DEPTH(type) == CV_8U ? 256 : 65536);
    return image;
}

std::vector<KeyPoint> scatter(Size size, int count)
{
    RNG rng(1);
    std::vector<KeyPoint> keypoints;
    for (int i = 0; i < count; i++)
        keypoints.push_back(KeyPoint(rng.uniform(0.f, (float)size.width),
                rng.uniform(0.f, (float)size.height), rng.uniform(8.f, 64.f), rng.uniform(0.f, 360.f)));
    return keypoints;
}

Mat describe(IIB& iib, const Mat& image, std::vector<KeyPoint> keypoints)
{
    Mat descriptors;
    const size_t count = keypoints.size();
    iib.compute(image, keypoints, descriptors);
    require(keypoints.size() == count && descriptors.rows == (int)count, "a keypoint is lost");
    return descriptors;
}

bool equal(const Mat& a, const Mat& b) { return a.size() == b.size() && norm(a, b, NORM_INF) == 0; }

}  // namespace iib_stress

int main(int argc, char** argv)
{
    using namespace iib_stress;
    const std::string what = argc > 1 ? argv[1] : "";
    const int amount = argc > 2 ? std::atoi(argv[2]) : 0;
    try
    {
        if (what == "keypoints")
            manyKeypoints(amount > 0 ? amount : 1000000);
        else if (what == "codes")
            manyCodes(amount > 0 ? amount : 1000000);
        else if (what == "pixels")
            largeImages(amount > 0 ? amount : 100);
        else if (what == "threads")
            manyThreads(amount > 0 ? amount : 120);
        else
        {
            std::fprintf(stderr, "iib_stress keypoints|codes|pixels|threads [AMOUNT]\n");
            return 2;
        }
    }
    catch (const std::exception& e)
    {
        std::fprintf(stderr, "%s: %s\n", what.c_str(), e.what());
        return 1;
    }
    return 0;
}
