// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "opencv2/imgproc.hpp"
#include "../test_precomp.hpp"

namespace opencv_test {

const Size SIZE(400, 300);

inline Mat spots(int seed, int count, const Size& size)
{
    RNG random(seed);
    Mat image(size, CV_8U, Scalar(120));
    for (int i = 0; i < count; i++)
    {
        const int y = random.uniform(0, size.height), x = random.uniform(0, size.width),
                  height = random.uniform(3, 30), width = random.uniform(3, 30),
                  grey = random.uniform(20, 230);
        const double turn = random.uniform(0., 180.);
        ellipse(image, Point(x, y), Size(width, height), turn, 0, 360, Scalar(grey), FILLED, LINE_AA);
    }
    return image;
}

//! Spots of all sizes; each seed gives another picture.
inline Mat picture(int seed)
{
    Mat image = spots(seed, 700, SIZE);
    GaussianBlur(image, image, Size(), .8);
    return image;
}

//! Half as bright, darker to one side, and noisy.
inline Mat inOtherLight(const Mat& image)
{
    Mat result = image.clone(), noise(image.size(), CV_16S);
    RNG random(9);
    random.fill(noise, RNG::NORMAL, 0, 2);
    for (int y = 0; y < image.rows; y++)
        for (int x = 0; x < image.cols; x++)
            result.at<uchar>(y, x) = saturate_cast<uchar>(
                    image.at<uchar>(y, x) * (.9 - .6 * x / image.cols) + 10 + noise.at<short>(y, x));
    return result;
}

//! Transforms a picture and changes its illumination. @param transform from the picture's pixels to the result's
inline Mat moved(const Mat& picture, const Matx33d& transform)
{
    Mat result;
    warpPerspective(picture, result, transform, SIZE, INTER_CUBIC, BORDER_REFLECT);
    return inOtherLight(result);
}

inline std::vector<Point2d> corners(const Matx33d& transform)
{
    const double right = SIZE.width - 1, bottom = SIZE.height - 1;
    std::vector<Point2d> result;
    for (const Vec3d& corner :
            {Vec3d(0, 0, 1), Vec3d(right, 0, 1), Vec3d(right, bottom, 1), Vec3d(0, bottom, 1)})
    {
        const Vec3d q = transform * corner;
        result.push_back(Point2d(q[0] / q[2], q[1] / q[2]));
    }
    return result;
}

//! Largest error of the image's corners, pixels.
inline double cornerError(const Mat& found, const Matx33d& truth)
{
    const std::vector<Point2d> a = corners(found), b = corners(truth);
    double error = 0;
    for (int k = 0; k < 4; k++)
        error = std::max(error, cv::norm(a[k] - b[k]));
    return error;
}

//! The result of alignImages.
struct Aligned
{
    Mat transform, error, matches;
    String reason, note;
    int simplest;
    bool found;

    Aligned(const Mat& reference, const Mat& image, int model)
        : found(cv::iib::alignImages(reference, image, transform, model, error, matches, &reason, noArray(),
                  noArray(), &simplest, &note))
    {
    }

    bool isRefused(const char* why) const { return !found && reason.find(why) != String::npos; }
    double at(int row, int column) const { return transform.at<double>(row, column); }
    double largestError() const { return cv::norm(error, NORM_INF); }
    double cornerError(const Matx33d& truth) const { return opencv_test::cornerError(transform, truth); }
};

const int MODELS[] = {cv::iib::ALIGN_TRANSLATION, cv::iib::ALIGN_SIMILARITY, cv::iib::ALIGN_AFFINE,
        cv::iib::ALIGN_HOMOGRAPHY};
const Matx33d TRANSLATION(1, 0, 7.3, 0, 1, -4.6, 0, 0, 1), SIMILARITY(1.04, -.1, 9, .1, 1.04, -12, 0, 0, 1),
        AFFINE(1.05, .03, 4, -.06, .97, 6, 0, 0, 1), HOMOGRAPHY(1.03, .04, 5, -.03, .98, 8, 1e-4, -8e-5, 1);
//! A transform of each of the MODELS.
const Matx33d TRUTHS[] = {TRANSLATION, SIMILARITY, AFFINE, HOMOGRAPHY};

}  // namespace opencv_test
