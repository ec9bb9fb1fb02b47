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
            const int xx = pixel(m, y, x - d) + pixel(m, y, x + d) - 2 * m(y, x);
            const int yy = pixel(m, y - d, x) + pixel(m, y + d, x) - 2 * m(y, x);
            const int corners = pixel(m, y - d, x - d) + pixel(m, y + d, x + d) - pixel(m, y - d, x + d) -
                                pixel(m, y + d, x - d);
            const int xy = (corners + 2) >> 2;
            result(y, x) = (float)(xx * yy - xy * xy) * factor;
        }
    return result;
}

//! Whether no neighbour in place and scale is larger, and no earlier one is equal.
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
    return KeyPoint(x + offsetX, y + offsetY, (float)(2 * sigma) * growth, -1, c, scale);
}

//! The scales of one resolution, from `first` on; the scales [begin, end) have keypoints.
struct Octave
{
    int spacing;  //!< of its pixels, in pixels of the image
    int first, begin, end;
    std::vector<Mat_<float>> responses;

    Octave(const Map& image, const std::vector<double>& sigmas, int begin_, int end_, int spacing_)
        : spacing(spacing_), first(std::max(begin_ - 1, 0)), begin(begin_), end(end_)
    {
        // without the last row and column of an odd size, which `halved` continues
        Map map = spacing == 1 ? image : Map(halved(image)(Rect(0, 0, image.cols / 2, image.rows / 2)));
        double variance = spacing == 1 ? 0. : .75 / 4;
        for (int scale = first; scale < std::min(end + 1, (int)sigmas.size()); scale++)
        {
            const double sigma = sigmas[scale] / spacing, wanted = sigma * sigma;
            while (wanted - variance > 1e-9)
            {
                const double added = std::min(wanted - variance, std::max(variance, 4. / 3));
                map = smoothed(smoothed(map, added, Point(0, 1)), added, Point(1, 0));
                variance += added;
            }
            responses.push_back(responsesOf(map, sigma));
        }
    }
};

}  // namespace

std::vector<KeyPoint> findBlobs(const Mat& grey, const iib::HessianDetector& p)
{
    Map image = normalizeLocally(grey, p.getNormalizationSigma());
    for (int& pixel : image)
        pixel = std::max(pixel - 128, -127) * 64;
    std::vector<double> sigmas;
    int fine = 0;
    for (int scale = 0; scale < p.getScales(); scale++)
    {
        sigmas.push_back(scale == 0 ? p.getSigma() : sigmas.back() * std::sqrt(2.));
        fine += sigmas.back() < 4;
    }
    std::vector<KeyPoint> keypoints;
    for (const Octave& octave :
            {Octave(image, sigmas, 0, fine, 1), Octave(image, sigmas, fine, p.getScales(), 2)})
        for (int scale = octave.begin; scale < octave.end; scale++)
        {
            const Mat_<float>& responses = octave.responses[scale - octave.first];
            const int border = (int)(2 * sigmas[scale] / octave.spacing) + 2;
            for (int y = border; y < responses.rows - border; y++)
                for (int x = border; x < responses.cols - border; x++)
                {
                    const float response = responses(y, x);
                    if (response <= 0 || response < p.getThreshold() ||
                            !isLargest(octave.responses, scale - octave.first, y, x))
                        continue;
                    KeyPoint kp = refined(octave.responses, scale - octave.first, y, x, sigmas[scale]);
                    if (octave.spacing == 2)
                        kp.pt = 2 * kp.pt + Point2f(.5f, .5f);
                    kp.octave = scale;
                    keypoints.push_back(kp);
                }
        }
    std::stable_sort(keypoints.begin(), keypoints.end(),
            [](const KeyPoint& a, const KeyPoint& b) { return a.response > b.response; });
    if (p.getMaxFeatures() > 0 && (int)keypoints.size() > p.getMaxFeatures())
        keypoints.resize(p.getMaxFeatures());
    return keypoints;
}

std::vector<KeyPoint> blobsByDefinition(const Mat& grey, const iib::HessianDetector& p)
{
    Mat image, xx, yy, xy;
    normalizeByDefinition(grey, p.getNormalizationSigma()).convertTo(image, CV_32F, 1. / 40);
    std::vector<Mat> responses, largest;
    std::vector<double> sigmas;
    for (int scale = 0; scale < p.getScales(); scale++)
    {
        sigmas.push_back(p.getSigma() * std::pow(2., scale / 2.));
        Mat smooth;
        GaussianBlur(image, smooth, Size(), sigmas[scale], 0, BORDER_REPLICATE);
        filter2D(smooth, xx, CV_32F, Matx13f(1, -2, 1));
        filter2D(smooth, yy, CV_32F, Matx31f(1, -2, 1));
        filter2D(smooth, xy, CV_32F, Matx33f(.25f, 0, -.25f, 0, 0, 0, -.25f, 0, .25f));
        responses.push_back(std::pow(sigmas[scale], 4) * (xx.mul(yy) - xy.mul(xy)));
        largest.push_back(Mat());
        dilate(responses[scale], largest[scale], Mat());
    }
    std::vector<KeyPoint> blobs;
    for (int scale = 0; scale < p.getScales(); scale++)
    {
        Mat above = largest[scale].clone();
        for (int other : {std::max(scale - 1, 0), std::min(scale + 1, p.getScales() - 1)})
            above = cv::max(above, largest[other]);
        std::vector<Point> places;
        findNonZero((responses[scale] >= above) & (responses[scale] > 0), places);
        for (const Point& place : places)
            blobs.push_back(KeyPoint(
                    place, (float)(2 * sigmas[scale]), -1, responses[scale].at<float>(place), scale));
    }
    return blobs;
}

}  // namespace oracle
