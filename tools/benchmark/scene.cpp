// SPDX-License-Identifier: Apache-2.0

#include "benchmark.hpp"

#include "opencv2/imgproc.hpp"

using namespace cv;

namespace iib_tools {

Mat cornerImage(Size size)
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

Mat relit(const Mat& image)
{
    Mat ramp(1, image.cols, CV_32F), result, noise(image.size(), CV_32F);
    for (int x = 0; x < image.cols; x++)
        ramp.at<float>(x) = 0.3f + 0.5f * float(x) / float(image.cols);
    image.convertTo(result, CV_32F);
    result = result.mul(repeat(ramp, image.rows, 1));
    theRNG().state = 4;
    randn(noise, 0, 6);
    result += noise;
    result.convertTo(result, CV_8U);
    return result;
}

std::vector<KeyPoint> corners(const Mat& image, size_t count)
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
    return chosen;
}

Mat described(const Ptr<Feature2D>& extractor, const Mat& image, std::vector<KeyPoint> keypoints)
{
    Mat descriptors;
    extractor->compute(image, keypoints, descriptors);
    return descriptors;
}

}  // namespace iib_tools
