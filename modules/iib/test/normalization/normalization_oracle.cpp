// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#include "normalization_oracle.hpp"

namespace oracle {

using namespace cv;

Map halved(const Map& m)
{
    const int weights[] = {1, 3, 3, 1};
    Map half((m.rows + 1) / 2, (m.cols + 1) / 2);
    for (int y = 0; y < half.rows; y++)
        for (int x = 0; x < half.cols; x++)
        {
            int sum = 32;
            for (int i = 0; i < 4; i++)
                for (int j = 0; j < 4; j++)
                    sum += weights[i] * weights[j] * pixel(m, 2 * y - 1 + i, 2 * x - 1 + j);
            half(y, x) = sum >> 6;
        }
    return half;
}

namespace {

//! Grey levels in 2^-7.
Map greyLevels(const Mat& grey)
{
    Map m(grey.size());
    double largest = 255;
    if (grey.depth() == CV_16U)
        minMaxIdx(grey, 0, &largest);
    const int64 factor = largest > 0 ? (int64)cvRound(255 * 128 * 65536. / largest) : 0;
    for (int y = 0; y < m.rows; y++)
        for (int x = 0; x < m.cols; x++)
            m(y, x) = grey.depth() == CV_8U ? grey.at<uchar>(y, x) * 128
                                            : (int)((grey.at<ushort>(y, x) * factor + 32768) >> 16);
    return m;
}

//! A quarter of the way to the nearest neighbour, first between rows, then between columns.
Map doubled(const Map& m, Size size)
{
    Map rows(size.height, m.cols), result(size);
    for (int y = 0; y < size.height; y++)
        for (int x = 0; x < m.cols; x++)
            rows(y, x) = m(y / 2, x) + ((pixel(m, y / 2 + (y % 2 ? 1 : -1), x) - m(y / 2, x)) >> 2);
    for (int y = 0; y < size.height; y++)
        for (int x = 0; x < size.width; x++)
            result(y, x) =
                    rows(y, x / 2) + ((pixel(rows, y, x / 2 + (x % 2 ? 1 : -1)) - rows(y, x / 2)) >> 2);
    return result;
}

Map blurredOnce(const Map& m, int weight, Point step)
{
    Map result(m.size());
    for (int y = 0; y < m.rows; y++)
        for (int x = 0; x < m.cols; x++)
        {
            const int neighbours = pixel(m, y - step.y, x - step.x) + pixel(m, y + step.y, x + step.x);
            result(y, x) = m(y, x) + ((weight * (neighbours - 2 * m(y, x)) + 128) >> 8);
        }
    return result;
}

//! The smallest map of the pyramid: `levels` times half the size.
Map smallest(Map m, double sigma, int levels)
{
    for (int i = 1; i < levels; i++)
        m = halved(m);
    const double scale = std::pow(4., levels), variance = (sigma * sigma - (scale - 1) / 2) / scale;
    const int passes = cvCeil(std::max(variance, 0.) * 1.5);
    for (int pass = 0; pass < passes; pass++)
    {
        const int weight = cvRound(128 * variance / passes);
        m = blurredOnce(blurredOnce(m, weight, Point(1, 0)), weight, Point(0, 1));
    }
    return m;
}

Map enlarged(Map m, Size size, int levels)
{
    std::vector<Size> sizes(1, size);
    for (int i = 1; i < levels; i++)
        sizes.push_back(Size((sizes.back().width + 1) / 2, (sizes.back().height + 1) / 2));
    for (int i = levels - 1; i >= 0; i--)
        m = doubled(m, sizes[i]);
    return m;
}

}  // namespace

Mat normalizeLocally(const Mat& grey, double sigma)
{
    const Map pixels = greyLevels(grey);
    const int levels = std::max((int)std::floor(std::log2(sigma)), 1);
    const Size size = pixels.size();
    const Map means = enlarged(smallest(halved(pixels), sigma, levels), size, levels);
    Map squares(size);
    for (int y = 0; y < size.height; y++)
        for (int x = 0; x < size.width; x++)
        {
            const int eighths = (pixels(y, x) - means(y, x) + 8) >> 4;
            squares(y, x) = eighths * eighths;
        }
    Map gains = smallest(halved(squares), sigma, levels);
    for (int& gain : gains)
        gain = cvRound(1024 * 40 * 8.f / (std::sqrt((float)gain) + 16));
    gains = enlarged(gains, size, levels);
    Mat result(size, CV_8U);
    for (int y = 0; y < size.height; y++)
        for (int x = 0; x < size.width; x++)
        {
            const int halves = ((pixels(y, x) - means(y, x)) * gains(y, x)) >> 16;
            result.at<uchar>(y, x) = saturate_cast<uchar>(((halves + 1) >> 1) + 128);
        }
    return result;
}

Mat normalizeByDefinition(const Mat& grey, double sigma)
{
    Mat image, mean, variance, deviation, result;
    grey.convertTo(image, CV_32F);
    GaussianBlur(image, mean, Size(), sigma, 0, BORDER_REPLICATE);
    const Mat difference = image - mean;
    GaussianBlur(difference.mul(difference), variance, Size(), sigma, 0, BORDER_REPLICATE);
    cv::sqrt(variance, deviation);
    const Mat ratio = difference / (deviation + 2);
    ratio.convertTo(result, CV_8U, 40, 128);
    return result;
}

}  // namespace oracle
