// SPDX-License-Identifier: Apache-2.0

#include "benchmark.hpp"

#include <fstream>
#ifdef __GLIBC__
#include <malloc.h>
#endif

using namespace cv;
using cv::iib::IIB;

namespace iib_tools {
namespace {

//! Peak of resident memory since the last call, bytes; 0 where the system does not tell.
double peakMemory()
{
    std::ifstream status("/proc/self/status");
    double kilobytes = 0;
    for (std::string line; std::getline(status, line);)
        if (line.compare(0, 6, "VmHWM:") == 0)
            kilobytes = atof(line.c_str() + 6);
    std::ofstream("/proc/self/clear_refs") << 5;
    return kilobytes * 1024;
}

//! Any places will do: what a keypoint looks like does not change the time.
std::vector<KeyPoint> scattered(Size size, int count)
{
    RNG rng(3);
    std::vector<KeyPoint> keypoints;
    for (int i = 0; i < count; i++)
        keypoints.push_back(KeyPoint(
                (float)rng.uniform(32, size.width - 32), (float)rng.uniform(32, size.height - 32), 31.f));
    return keypoints;
}

//! Peak of memory beyond image and descriptors, all pixels touched.
double bytesPerPixel(const Mat& image)
{
    const Ptr<IIB> iib = IIB::create();
    std::vector<KeyPoint> keypoints = scattered(image.size(), 20000);
    Mat descriptors((int)keypoints.size(), iib->descriptorSize(), CV_8U, Scalar(0));  // all pages touched
#ifdef __GLIBC__
    malloc_trim(0);  // else what was freed before would be used again, and not be seen
#endif
    peakMemory();
    const double before = peakMemory();
    iib->compute(image, keypoints, descriptors);
    return (peakMemory() - before) / image.total();
}

struct Point
{
    Mat image;
    std::vector<KeyPoint> keypoints;
};

void measurePoints(FileStorage& fs, const String& name, const std::vector<Point>& points, int rounds)
{
    const Ptr<Feature2D> features[] = {IIB::create(), ORB::create()};
    std::vector<KeyPoint> keypoints;
    Mat descriptors;
    std::vector<Task> tasks;
    for (const Point& point : points)
        for (const Ptr<Feature2D>& feature : features)
            tasks.push_back({[&] {
                                 keypoints = point.keypoints;
                                 feature->compute(point.image, keypoints, descriptors);
                             },
                    1, 1});
    const std::vector<double> milliseconds = measure(tasks, rounds);
    fs << name << "[";
    for (size_t i = 0; i < points.size(); i++)
        fs << "{"
           << "megapixels" << points[i].image.total() * 1e-6 << "keypoints" << (int)points[i].keypoints.size()
           << "milliseconds" << milliseconds[2 * i] << "orb_milliseconds" << milliseconds[2 * i + 1] << "}";
    fs << "]";
}

}  // namespace

void measureGrowth(FileStorage& fs, int rounds)
{
    const Mat large = cornerImage(Size(6000, 4000)), small = large(Rect(0, 0, 1280, 720));
    const double memory = bytesPerPixel(large);
    std::vector<Point> pixels, keypoints;
    for (double side : {0.125, 0.25, 0.375, 0.5, 0.75, 1.})
    {
        const Mat image = large(Rect(0, 0, cvRound(large.cols * side), cvRound(large.rows * side)));
        pixels.push_back({image, scattered(image.size(), 1000)});
    }
    for (int count : {1000, 2000, 4000, 8000, 16000})
        keypoints.push_back({small, scattered(small.size(), count)});

    // The same keypoints on a crop and on the whole.
    const Rect crop(2400, 1600, 1000, 1000);
    std::vector<Point> cropAndWhole(2, {large, scattered(crop.size(), 20)});
    cropAndWhole[0].image = large(crop).clone();
    for (KeyPoint& kp : cropAndWhole[1].keypoints)
        kp.pt += Point2f(crop.tl());

    measurePoints(fs, "pixels", pixels, rounds);
    measurePoints(fs, "more_keypoints", keypoints, rounds);
    measurePoints(fs, "crop_and_whole", cropAndWhole, rounds);
    fs << "bytes_per_pixel" << memory;
}

}  // namespace iib_tools
