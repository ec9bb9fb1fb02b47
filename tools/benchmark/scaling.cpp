// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#include "scaling.hpp"
#include "scene.hpp"

#include "opencv2/core/utility.hpp"
#include "opencv2/iib.hpp"

#include <cstdio>
#include <fstream>
#ifdef __GLIBC__
#include <malloc.h>
#endif

using namespace cv;
using cv::iib::IIB;

namespace iib_tools {

namespace {

const Size LARGE(6000, 4000);

double megapixels(const Mat& image) { return image.total() * 1e-6; }

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
std::vector<KeyPoint> scattered(Rect area, int count)
{
    RNG rng(3);
    std::vector<KeyPoint> keypoints;
    for (int i = 0; i < count; i++)
        keypoints.push_back(KeyPoint((float)rng.uniform(area.x + 32, area.br().x - 32),
                (float)rng.uniform(area.y + 32, area.br().y - 32), 31.f));
    return keypoints;
}

struct Task
{
    Mat image;
    std::vector<KeyPoint> keypoints;
    Scaling::Point* result;
};

void measure(const std::vector<Task>& tasks, int rounds)
{
    const Ptr<IIB> iib = IIB::create();
    const Ptr<Feature2D> orb = ORB::create();
    Mat descriptors;
    for (const Task& task : tasks)
    {
        const Scaling::Point begun = {megapixels(task.image), (int)task.keypoints.size(), DBL_MAX, DBL_MAX};
        *task.result = begun;
    }
    for (int round = 0; round < rounds; round++)
        for (const Task& task : tasks)
        {
            std::vector<KeyPoint> keypoints = task.keypoints;
            TickMeter meter;
            meter.start();
            iib->compute(task.image, keypoints, descriptors);
            meter.stop();
            task.result->milliseconds = std::min(task.result->milliseconds, meter.getTimeMilli());
            keypoints = task.keypoints;
            meter.reset();
            meter.start();
            orb->compute(task.image, keypoints, descriptors);
            meter.stop();
            task.result->orbMilliseconds = std::min(task.result->orbMilliseconds, meter.getTimeMilli());
        }
}

double bytesPerPixel(const Mat& image)
{
    const Ptr<IIB> iib = IIB::create();
    std::vector<KeyPoint> keypoints = scattered(Rect(Point(), image.size()), 20000);
    Mat descriptors((int)keypoints.size(), iib->descriptorSize(), CV_8U, Scalar(0));  // all pages touched
#ifdef __GLIBC__
    malloc_trim(0);  // else what was freed before would be used again, and not be seen
#endif
    peakMemory();
    const double before = peakMemory();
    iib->compute(image, keypoints, descriptors);
    return (peakMemory() - before) / image.total();
}

void write(FileStorage& fs, const String& name, const std::vector<Scaling::Point>& points)
{
    fs << name << "[";
    for (const Scaling::Point& p : points)
        fs << "{"
           << "megapixels" << p.megapixels << "keypoints" << p.keypoints << "milliseconds" << p.milliseconds
           << "orb_milliseconds" << p.orbMilliseconds << "}";
    fs << "]";
}

void print(const Scaling::Point& p)
{
    printf("%8.2f Mpx %6d keypoints %8.3f ms, ORB %8.3f ms\n", p.megapixels, p.keypoints, p.milliseconds,
            p.orbMilliseconds);
}

}  // namespace

Scaling measureScaling(int rounds)
{
    setNumThreads(1);
    Scaling s;
    const Mat large = cornerImage(LARGE);
    s.bytesPerPixel = bytesPerPixel(large);

    const double sides[] = {0.125, 0.25, 0.375, 0.5, 0.75, 1};
    const int counts[] = {1000, 2000, 4000, 8000, 16000};
    s.pixels.resize(sizeof(sides) / sizeof(sides[0]));
    s.keypoints.resize(sizeof(counts) / sizeof(counts[0]));
    std::vector<Task> tasks;
    for (size_t i = 0; i < s.pixels.size(); i++)
    {
        const Mat image =
                large(Rect(0, 0, cvRound(LARGE.width * sides[i]), cvRound(LARGE.height * sides[i])));
        tasks.push_back(Task{image, scattered(Rect(Point(), image.size()), 1000), &s.pixels[i]});
    }
    const Mat small = large(Rect(0, 0, 1280, 720));
    for (size_t i = 0; i < s.keypoints.size(); i++)
        tasks.push_back(Task{small, scattered(Rect(Point(), small.size()), counts[i]), &s.keypoints[i]});

    const Rect crop(2400, 1600, 1000, 1000);
    std::vector<KeyPoint> inCrop = scattered(Rect(Point(), crop.size()), 20), inLarge = inCrop;
    for (KeyPoint& kp : inLarge)
        kp.pt += Point2f(crop.tl());
    tasks.push_back(Task{large(crop).clone(), inCrop, &s.crop});
    tasks.push_back(Task{large, inLarge, &s.around});
    measure(tasks, rounds);
    return s;
}

void Scaling::print() const
{
    printf("\nDefault, more pixels, then more keypoints\n");
    for (const Point& p : pixels)
        iib_tools::print(p);
    for (const Point& p : keypoints)
        iib_tools::print(p);
    printf("The same keypoints on a crop and on the whole: ratio %.2f\n",
            around.milliseconds / crop.milliseconds);
    iib_tools::print(crop);
    iib_tools::print(around);
    printf("Peak of memory beyond image and descriptors: %.2f bytes a pixel\n", bytesPerPixel);
}

void Scaling::write(FileStorage& fs) const
{
    iib_tools::write(fs, "pixels", pixels);
    iib_tools::write(fs, "more_keypoints", keypoints);
    iib_tools::write(fs, "crop_and_whole", {crop, around});
    fs << "bytes_per_pixel" << bytesPerPixel;
}

}  // namespace iib_tools
