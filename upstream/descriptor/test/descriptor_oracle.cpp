// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#include "test_precomp.hpp"

#include <array>

namespace oracle {

using namespace cv;
typedef cv::iib::IIBDescriptorExtractor IIB;

int orientation(int gx, int gy)
{
    const float a = (float)std::abs(gx), b = (float)std::abs(gy);
    const float t = std::min(a, b) / std::max(std::max(a, b), 1.f), t2 = t * t;
    int steps = cvRound(((12.9301834f * t2 - 47.0491257f) * t2 + 162.218109f) * t);
    if (b > a)
        steps = 256 - steps;
    if (gx < 0)
        steps = 512 - steps;
    if (gy > 0)
        steps = 1024 - steps;
    return steps % 1024;
}

namespace {

//! The nearest pixel of the image.
int pixel(const Mat& image, int y, int x)
{
    return image.at<uchar>(
            std::min(std::max(y, 0), image.rows - 1), std::min(std::max(x, 0), image.cols - 1));
}

//! BORDER_REFLECT_101.
int reflected(int place, int size)
{
    place = std::abs(place);
    return std::max(std::min(place, 2 * (size - 1) - place), 0);
}

//! The channels in use at a pixel, which may lie beside the image.
std::vector<int> valuesOf(int channels, const Mat& grey, int y, int x)
{
    y = reflected(y, grey.rows);
    x = reflected(x, grey.cols);
    int gx = 0, gy = 0;  // Sobel's
    for (int i = -1; i <= 1; i++)
    {
        gx += (2 - i * i) * (pixel(grey, y + i, x + 1) - pixel(grey, y + i, x - 1));
        gy += (2 - i * i) * (pixel(grey, y + 1, x + i) - pixel(grey, y - 1, x + i));
    }
    const int all[] = {std::abs(gx), std::abs(gy), orientation(gx, gy), pixel(grey, y, x)};
    std::vector<int> values;
    for (int i = 0; i < 4; i++)
        if (channels >> i & 1)
            values.push_back(all[i]);
    return values;
}

//! A channel's sum, and the number of pixels.
struct Cell
{
    int64 sum, count;
};

//! Edge k of n cells in a row, among pixels of the image and of its reflections.
int edge(double start, double side, int k, int n, int size)
{
    return (int)std::min(std::max(std::floor(start + side / n * k + 0.5), 1. - size), 2. * size - 1);
}

//! Cell (row, col) of a grid of n x n, in each channel.
std::vector<Cell> cellsAt(const IIB& iib, const Mat& grey, const KeyPoint& kp, int n, int row, int col)
{
    const double side = std::max((double)iib.getScaleFactor() * kp.size, (double)(1 << iib.getGranularity()));
    const double x = kp.pt.x + 0.5 - side / 2, y = kp.pt.y + 0.5 - side / 2;
    const int x0 = edge(x, side, col, n, grey.cols), x1 = edge(x, side, col + 1, n, grey.cols);
    const int y0 = edge(y, side, row, n, grey.rows), y1 = edge(y, side, row + 1, n, grey.rows);
    std::vector<Cell> cells(
            valuesOf(iib.getChannels(), grey, 0, 0).size(), Cell{0, (int64)(x1 - x0) * (y1 - y0)});
    for (int i = y0; i < y1; i++)
        for (int j = x0; j < x1; j++)
        {
            const std::vector<int> values = valuesOf(iib.getChannels(), grey, i, j);
            for (size_t c = 0; c < values.size(); c++)
                cells[c].sum += values[c];
        }
    return cells;
}

//! Paper, "Binary Bit Formulation".
std::vector<bool> mapQuad(int mapping, const std::array<Cell, 4>& q)
{
    // With widths w0, w1 and heights h0, h1 of the cells, count_i * count_(3-i) is the same for all i. So this is the mean
    // of cell i but for a factor common to the four.
    int64 x[4], sum = 0;
    for (int i = 0; i < 4; i++)
        sum += x[i] = q[i].sum * q[3 - i].count;
    const int64 lo = *std::min_element(x, x + 4), hi = *std::max_element(x, x + 4);
    std::vector<bool> bits;
    for (int i = 0; i < 4; i++)
    {
        int code = 0;
        switch (mapping)
        {
        case IIB::MAPPING_MEAN: bits.push_back(4 * x[i] > sum); continue;
        case IIB::MAPPING_MAX: bits.push_back(x[i] == hi); continue;
        case IIB::MAPPING_MIN: bits.push_back(x[i] == lo); continue;
        case IIB::MAPPING_QUARTILE:
            code = (4 * (x[i] - lo) > hi - lo) + (2 * (x[i] - lo) > hi - lo) +
                   (4 * (x[i] - lo) > 3 * (hi - lo));
            break;
        default:
            for (int j = 0; j < 4; j++)
                code += x[j] < x[i] || (x[j] == x[i] && j < i);
        }
        bits.push_back((code & 2) != 0);
        bits.push_back((code & 1) != 0);
    }
    return bits;
}

std::vector<bool> levelBits(const IIB& iib, const Mat& grey, const KeyPoint& kp, int level)
{
    const int n = 1 << level;
    std::vector<std::vector<Cell>> cells;
    for (int i = 0; i < n * n; i++)
        cells.push_back(cellsAt(iib, grey, kp, n, i / n, i % n));
    const size_t channels = cells[0].size();
    std::vector<bool> result;
    for (int window = 0; window < (iib.getOverlap() ? 4 : 1); window++)
        for (int row = window / 2; row + 1 < n; row += 2)
        {
            std::vector<std::vector<bool>> quads;  // of the row, channel by channel
            for (int col = window % 2; col + 1 < n; col += 2)
                for (size_t c = 0; c < channels; c++)
                {
                    const int i = row * n + col;
                    quads.push_back(mapQuad(iib.getMapping(),
                            {{cells[i][c], cells[i + 1][c], cells[i + n][c], cells[i + n + 1][c]}}));
                }
            for (size_t bit = 0; !quads.empty() && bit < quads[0].size(); bit++)
                for (const std::vector<bool>& quad : quads)
                    result.push_back(quad[bit]);
        }
    return result;
}

}  // namespace

Mat describe(const IIB& iib, const Mat& grey, const std::vector<KeyPoint>& keypoints)
{
    Mat descriptors;
    for (const KeyPoint& kp : keypoints)
    {
        std::vector<uchar> bytes;
        for (int level = 1; level <= iib.getGranularity(); level++)
        {
            const std::vector<bool> bits = levelBits(iib, grey, kp, level);
            const size_t start = bytes.size();
            bytes.resize(start + (bits.size() + 7) / 8, 0);
            for (size_t i = 0; i < bits.size(); i++)
                bytes[start + i / 8] |= (uchar)((int)bits[i] << i % 8);
        }
        descriptors.push_back(Mat(bytes).reshape(1, 1).clone());
    }
    return descriptors;
}

}  // namespace oracle
