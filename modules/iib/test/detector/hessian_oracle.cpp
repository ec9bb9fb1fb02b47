// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#include "../normalization/normalization_oracle.hpp"
#include "hessian_oracle.hpp"

namespace oracle {

using namespace cv;

namespace {

//! Adds a variance: twice (w, 1 - 2 w, w), `spacing` apart, in 2^-16 rounded down.
Map smoothed(const Map& m, double variance, Point direction)
{
    const int spacing = cvCeil(std::sqrt(.75 * variance));
    const double w = variance / (4 * spacing * spacing);
    const int64 near = cvRound(2 * w * (1 - 2 * w) * 65536), far = cvRound(w * w * 65536);
    const Point step = direction * spacing;
    Map result(m.size());
    for (int y = 0; y < m.rows; y++)
        for (int x = 0; x < m.cols; x++)
        {
            const int nearer =
                    pixel(m, y - step.y, x - step.x) + pixel(m, y + step.y, x + step.x) - 2 * m(y, x);
            const int farther = pixel(m, y - 2 * step.y, x - 2 * step.x) +
                                pixel(m, y + 2 * step.y, x + 2 * step.x) - 2 * m(y, x);
            result(y, x) = m(y, x) + (int)((near * nearer) >> 16) + (int)((far * farther) >> 16);
        }
    return result;
}

Mat_<float> responsesOf(const Map& m, double sigma)
{
    const int d = std::max(cvRound(.75 * sigma), 1);
    const double unit = 40 * 64;
    const float factor = (float)(std::pow(sigma * sigma, 2) / (std::pow(d, 4.) * unit * unit));
    Mat_<float> result(m.size());
    for (int y = 0; y < m.rows; y++)
        for (int x = 0; x < m.cols; x++)
        {
            const float xx = (float)(pixel(m, y, x - d) + pixel(m, y, x + d) - 2 * m(y, x));
            const float yy = (float)(pixel(m, y - d, x) + pixel(m, y + d, x) - 2 * m(y, x));
            const float xy = (float)(pixel(m, y - d, x - d) + pixel(m, y + d, x + d) -
                                     pixel(m, y - d, x + d) - pixel(m, y + d, x - d));
            result(y, x) = (xx * yy - xy * xy * (1.f / 16)) * factor;
        }
    return result;
}

//! Whether no neighbour in place and scale is larger, and none that comes earlier is as large.
bool isLargest(const std::vector<Mat_<float>>& responses, int scale, int y, int x)
{
    const float value = responses[scale](y, x);
    for (int s = std::max(scale - 1, 0); s <= std::min(scale + 1, (int)responses.size() - 1); s++)
        for (int dy = -1; dy <= 1; dy++)
            for (int dx = -1; dx <= 1; dx++)
            {
                const float other = responses[s](y + dy, x + dx);
                const bool earlier = s < scale || (s == scale && (dy < 0 || (dy == 0 && dx < 0)));
                if (other > value || (earlier && other == value))
                    return false;
            }
    return true;
}

float within(float value, float limit) { return std::max(-limit, std::min(limit, value)); }

KeyPoint refined(const std::vector<Mat_<float>>& responses, int scale, int y, int x, double sigma)
{
    const Mat_<float>& r = responses[scale];
    const float c = r(y, x);
    const float dx = (r(y, x + 1) - r(y, x - 1)) / 2, dy = (r(y + 1, x) - r(y - 1, x)) / 2;
    const float xx = r(y, x + 1) + r(y, x - 1) - 2 * c, yy = r(y + 1, x) + r(y - 1, x) - 2 * c;
    const float xy = (r(y + 1, x + 1) + r(y - 1, x - 1) - r(y - 1, x + 1) - r(y + 1, x - 1)) / 4;
    const float determinant = xx * yy - xy * xy;
    const float offsetX = determinant > 0 ? within((xy * dy - yy * dx) / determinant, .7f) : 0;
    const float offsetY = determinant > 0 ? within((xy * dx - xx * dy) / determinant, .7f) : 0;
    float step = 0;
    if (scale > 0 && scale + 1 < (int)responses.size())
    {
        const float before = responses[scale - 1](y, x), after = responses[scale + 1](y, x);
        const float curvature = before + after - 2 * c;
        if (curvature < 0)
            step = within((before - after) / (2 * curvature), .5f);
    }
    const float growth = 1 + step * (.34657359f + step * .06005663f);  // 2^(step / 2), nearly
    return KeyPoint(
            2 * (x + offsetX) + .5f, 2 * (y + offsetY) + .5f, (float)(4 * sigma) * growth, -1, c, scale);
}

}  // namespace

std::vector<KeyPoint> findBlobs(const Mat& grey, const iib::HessianDetector& p)
{
    Map image = normalizeHalf(grey, p.getNormalizationSigma());
    for (int& pixel : image)
        pixel = std::max(pixel - 128, -127) * 64;
    std::vector<double> sigmas;
    std::vector<Mat_<float>> responses;
    double variance = 0;
    for (int scale = 0; scale < p.getScales(); scale++)
    {
        sigmas.push_back(scale == 0 ? p.getSigma() / 2. : sigmas.back() * std::sqrt(2.));
        const double wanted = sigmas.back() * sigmas.back();
        while (wanted - variance > 1e-9)
        {
            const double added = std::min(wanted - variance, std::max(variance, 4. / 3));
            image = smoothed(smoothed(image, added, Point(0, 1)), added, Point(1, 0));
            variance += added;
        }
        responses.push_back(responsesOf(image, sigmas.back()));
    }
    std::vector<KeyPoint> keypoints;
    for (int scale = 0; scale < p.getScales(); scale++)
    {
        const int border = (int)(2 * sigmas[scale]) + 2;
        for (int y = border; y < image.rows - border; y++)
            for (int x = border; x < image.cols - border; x++)
            {
                const float response = responses[scale](y, x);
                if (response > 0 && response >= p.getThreshold() && isLargest(responses, scale, y, x))
                    keypoints.push_back(refined(responses, scale, y, x, sigmas[scale]));
            }
    }
    std::stable_sort(keypoints.begin(), keypoints.end(),
            [](const KeyPoint& a, const KeyPoint& b) { return a.response > b.response; });
    if (p.getMaxFeatures() > 0 && (int)keypoints.size() > p.getMaxFeatures())
        keypoints.resize(p.getMaxFeatures());
    return keypoints;
}

}  // namespace oracle
