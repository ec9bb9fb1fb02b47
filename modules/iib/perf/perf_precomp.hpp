// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#pragma once

#include "opencv2/iib.hpp"
#include "opencv2/imgcodecs.hpp"
#include "opencv2/imgproc.hpp"
#include "opencv2/ts.hpp"

namespace opencv_test {
using namespace cv::iib;
using namespace perf;

//! Sets the number of threads during its lifetime.
struct Threads
{
    const int before;
    explicit Threads(int count) : before(getNumThreads()) { setNumThreads(count); }
    ~Threads() { setNumThreads(before); }
};

/** A picture of 640 x 480 pixels: "scene", the authors', below OPENCV_TEST_DATA_PATH; others by their name in tools/synthetic,
which the stand-alone build knows: rendered. A test whose picture is missing is skipped. */
inline Mat picture(const std::string& name)
{
    const char* data = getenv("OPENCV_TEST_DATA_PATH");
    std::string file = std::string(data ? data : "") + "/illumination/iib_demo/scene/1.png";
#ifdef IIB_PERF_PICTURES
    if (name != "scene")
        file = std::string(IIB_PERF_PICTURES) + "/" + name + ".jpg";
#else
    if (name != "scene")
        file.clear();
#endif
    const Mat image = file.empty() ? Mat() : imread(file, IMREAD_GRAYSCALE);
    if (image.empty())
        throw SkipTestException("no picture " + name);
    return image;
}

//! A grey image with corners everywhere: blurred noise at two scales.
inline Mat cornerImage(Size size)
{
    RNG rng(1);
    Mat fine(size, CV_8U), coarse(size / 8, CV_8U), image;
    rng.fill(fine, RNG::UNIFORM, 0, 256);
    rng.fill(coarse, RNG::UNIFORM, 0, 256);
    GaussianBlur(fine, fine, Size(5, 5), 1.);
    resize(coarse, coarse, size, 0, 0, INTER_CUBIC);
    addWeighted(fine, 0.5, coarse, 0.5, 0, image);
    return image;
}

//! FAST corners, spread over the image, with ORB's size, away from the border, where ORB would drop them.
inline std::vector<KeyPoint> corners(const Mat& image, size_t count)
{
    std::vector<KeyPoint> all, chosen;
    FAST(image, all, 5);
    RNG rng(2);
    for (size_t i = all.size(); i > 1; i--)
        std::swap(all[i - 1], all[rng.uniform(0, (int)i)]);
    const Rect inside(32, 32, image.cols - 64, image.rows - 64);
    for (size_t i = 0; i < all.size() && chosen.size() < count; i++)
        if (inside.contains(all[i].pt))
        {
            chosen.push_back(all[i]);
            chosen.back().size = 31;
            chosen.back().angle = rng.uniform(0.f, 360.f);
        }
    CV_Assert(chosen.size() == count);
    return chosen;
}

}  // namespace opencv_test
