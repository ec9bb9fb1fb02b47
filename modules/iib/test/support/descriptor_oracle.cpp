// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#include "descriptor_oracle.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>

#include "../../src/descriptor/kernels/kernels.hpp"

namespace oracle {

using namespace cv;
typedef cv::iib::IIBDescriptorExtractor IIB;

int orientation(int gx, int gy)
{
    const float a = (float)std::abs(gx), b = (float)std::abs(gy);
    const float t = std::min(a, b) / std::max(std::max(a, b), 1.f), t2 = t * t;
    int steps = cvRound(((cv::iib::ATAN_C * t2 + cv::iib::ATAN_B) * t2 + cv::iib::ATAN_A) * t);
    const int turn = cv::iib::ORIENTATION_STEPS;
    if (b > a)
        steps = turn / 4 - steps;
    if (gx < 0)
        steps = turn / 2 - steps;
    if (gy > 0)
        steps = turn - steps;
    return steps % turn;
}

Point gradient(const Mat& m, int y, int x)
{
    Point g;
    for (int i = -1; i <= 1; i++)
    {
        g.x += (2 - i * i) * (pixel(m, y + i, x + 1) - pixel(m, y + i, x - 1));
        g.y += (2 - i * i) * (pixel(m, y + 1, x + i) - pixel(m, y - 1, x + i));
    }
    return g;
}

int64 reflectTo(int64 v, int limit)
{
    v = std::abs(v);
    return std::max<int64>(std::min<int64>(v, 2 * (limit - 1) - v), 0);
}

namespace {

//! The values of all channels in use at one pixel, given its gradient.
std::vector<int> valuesOf(
        int enabled, const Mat& grey, Point g, int steps, const std::vector<Mat>& extra, int y, int x)
{
    const int offset = grey.depth() == CV_8U ? 6 * 255 : 6 * 65535;  // keeps signed gradients positive
    // in the order of CHANNEL_ values, which are 1, 2, 4 and so on
    const int values[] = {std::abs(g.x), std::abs(g.y), steps, pixel(grey, y, x), g.x + offset, g.y + offset};
    std::vector<int> v;
    v.reserve(6 + extra.size());
    for (int i = 0; i < 6; i++)
        if (enabled >> i & 1)
            v.push_back(values[i]);
    for (size_t i = 0; i < extra.size(); i++)
        v.push_back(pixel(extra[i], y, x));
    return v;
}

//! One channel's sum and number of pixels in a cell.
struct Cell
{
    int64 sum, count;
};
typedef std::array<Cell, 4> Quad;

//! Cell (row, col) of a grid of n x n.
typedef std::function<Cell(int channel, int n, int row, int col)> Cells;

struct SupportRegion
{
    double x, y, side;

    SupportRegion(const IIB& iib, const KeyPoint& kp)
        : side(std::max((double)iib.getScaleFactor() * kp.size, (double)(1 << iib.getGranularity())))
    {
        x = kp.pt.x + 0.5 - side / 2;
        y = kp.pt.y + 0.5 - side / 2;
    }
};

//! An edge in [0, limit], or within one reflection on either side.
int edge(double start, double side, int k, int n, int limit, bool reflect)
{
    const double least = reflect ? 1 - limit : 0, most = reflect ? 2 * limit - 1 : limit;
    return (int)std::min(std::max(std::floor(start + side / n * k + 0.5), least), most);
}

Cell uprightCell(const Channel& c, const SupportRegion& r, int n, int row, int col, bool reflect)
{
    const int x0 = edge(r.x, r.side, col, n, c.cols, reflect),
              x1 = edge(r.x, r.side, col + 1, n, c.cols, reflect);
    const int y0 = edge(r.y, r.side, row, n, c.rows, reflect),
              y1 = edge(r.y, r.side, row + 1, n, c.rows, reflect);
    Cell cell = {0, (int64)(x1 - x0) * (y1 - y0)};
    for (int y = y0; y < y1; y++)
        for (int x = x0; x < x1; x++)
            cell.sum += c((int)reflectTo(y, c.rows), (int)reflectTo(x, c.cols));
    return cell;
}

int64 clampTo(int64 v, int limit) { return std::min<int64>(std::max<int64>(v, 0), limit - 1); }

//! Centre of a grid of points, in 2^-17 pixels; pixel 0 begins at 0. Clamped to 2^29 pixels.
int64 fixedPoint(double centre)
{
    const double far = 1 << 29;
    return (int64)std::floor(std::min(std::max(centre, -far), far) * 131072 + 65536.5);
}

int insideOf(const IIB& iib, int64 place, int limit)
{
    return (int)(iib.getBorder() == IIB::BORDER_REFLECT ? reflectTo(place, limit) : clampTo(place, limit));
}

//! A peak of the directions of gradients between 32 x 32 cells in a circle, 64 bins weighted by magnitude and a
//! Gaussian, smoothed.
float prevailingAngle(const IIB& iib, const Mat& grey, const KeyPoint& kp, size_t rank)
{
    const int samples = 64, n = 32, bins = 64;
    const int64 step = cvRound(std::min(SupportRegion(iib, kp).side, 16384.) / samples * 65536);
    Mat_<int> cells = Mat_<int>::zeros(n, n);
    for (int row = 0; row < samples; row++)
        for (int col = 0; col < samples; col++)
        {
            const int u = 2 * col + 1 - samples, v = 2 * row + 1 - samples;
            const int x = insideOf(iib, (fixedPoint(kp.pt.x) + u * step) >> 17, grey.cols);
            const int y = insideOf(iib, (fixedPoint(kp.pt.y) + v * step) >> 17, grey.rows);
            cells(row / 2, col / 2) += pixel(grey, y, x);
        }
    std::vector<int64> histogram(bins, 0);
    for (int row = 1; row < n - 1; row++)
        for (int col = 1; col < n - 1; col++)
        {
            const double dx = (2. * col + 1 - n) / n, dy = (2. * row + 1 - n) / n;
            if (dx * dx + dy * dy > 1)
                continue;
            const int weight = cvRound(32 * std::exp(-2 * dx * dx)) * cvRound(32 * std::exp(-2 * dy * dy));
            const Point g = gradient(cells, row, col);
            const float x = (float)g.x, y = (float)g.y;
            histogram[orientation(g.x, g.y) / 16] += cvRound(std::sqrt(x * x + y * y) * (float)weight);
        }
    for (int pass = 0; pass < 6; pass++)
    {
        const std::vector<int64> h = histogram;
        for (int i = 0; i < bins; i++)
            histogram[i] = h[(i + bins - 2) % bins] + h[(i + bins - 1) % bins] + h[i] + h[(i + 1) % bins] +
                           h[(i + 2) % bins];
    }
    std::vector<std::pair<int64, int>> peaks;  // highest first, the lower bin first
    for (int i = 0; i < bins; i++)
        if (histogram[i] > histogram[(i + bins - 1) % bins] && histogram[i] >= histogram[(i + 1) % bins])
            peaks.push_back(std::make_pair(-histogram[i], i));
    if (peaks.empty())
        return 0;
    std::sort(peaks.begin(), peaks.end());
    const int best = peaks[std::min(rank, peaks.size() - 1)].second;
    const int64 left = histogram[(best + bins - 1) % bins], right = histogram[(best + 1) % bins];
    const int64 curvature = left - 2 * histogram[best] + right;
    const double top = curvature ? 0.5 * (double)(left - right) / (double)curvature : 0;
    const double turns = (best + top + 15 / 32.) / bins;
    const float angle = (float)(360 * (turns <= 0 ? -turns : 1 - turns));
    return angle < 360 ? angle : 0;
}

//! A region and its gradients rotated by an angle: the nearest pixels on a grid of samples x samples.
struct RotatedRegion
{
    int samples;
    std::vector<Channel> values;

    RotatedRegion(
            const IIB& iib, const Mat& grey, const std::vector<Mat>& extra, const KeyPoint& kp, float angle)
    {
        const SupportRegion ros(iib, kp);
        samples = ros.side <= 64 && iib.getGranularity() <= 5 ? 32 : 64;
        angle = std::fmod(angle, 360.f);  // exact, and small enough for cvRound()
        const double radians = angle * CV_PI / 180, spacing = std::min(ros.side, 16384.) / samples;
        const int64 stepX = cvRound(std::cos(radians) * spacing * 65536);
        const int64 stepY = cvRound(std::sin(radians) * spacing * 65536);
        const int cosine = cvRound(std::cos(radians) * 4096), sine = cvRound(std::sin(radians) * 4096);
        const int turn = cvRound(angle * cv::iib::ORIENTATION_STEPS / 360);
        const int64 x0 = fixedPoint(kp.pt.x), y0 = fixedPoint(kp.pt.y);

        for (int row = 0; row < samples; row++)
            for (int col = 0; col < samples; col++)
            {
                const int u = 2 * col + 1 - samples, v = 2 * row + 1 - samples;
                const int x = insideOf(iib, (x0 + u * stepX - v * stepY) >> 17, grey.cols);
                const int y = insideOf(iib, (y0 + u * stepY + v * stepX) >> 17, grey.rows);
                const Point g = gradient(grey, y, x), rotated((cosine * g.x + sine * g.y + 2048) >> 12,
                                                              (cosine * g.y - sine * g.x + 2048) >> 12);
                const int steps =
                        g == Point() ? 0 : (orientation(g.x, g.y) + turn) & (cv::iib::ORIENTATION_STEPS - 1);
                const std::vector<int> all = valuesOf(iib.getChannels(), grey, rotated, steps, extra, y, x);
                while (values.size() < all.size())
                    values.push_back(Channel(samples, samples));
                for (size_t c = 0; c < all.size(); c++)
                    values[c](row, col) = all[c];
            }
    }

    Cell cell(int c, int n, int row, int col) const
    {
        const int side = samples / n;
        const Rect r(col * side, row * side, side, side);
        Cell result = {(int64)sum(values[c](r))[0], r.area()};
        return result;
    }
};

/* mean_i = sum_i / count_i. With widths w0, w1 and heights h0, h1 the counts are w0 h0, w1 h0, w0 h1,
 w1 h1, so count_i * count_(3-i) is the same for all i, and sum_i * count_(3-i) is mean_i but for a
 factor common to the four. */
std::array<int64, 4> comparable(const Quad& q)
{
    std::array<int64, 4> x = {};
    for (int i = 0; i < 4; i++)
        x[i] = q[i].sum * q[3 - i].count;
    return x;
}

//! Paper, "Binary Bit Formulation".
std::vector<bool> mapQuad(int mapping, const std::array<int64, 4>& x)
{
    std::vector<bool> bits;
    const int64 sum = x[0] + x[1] + x[2] + x[3];
    const int64 lo = *std::min_element(x.begin(), x.end()), hi = *std::max_element(x.begin(), x.end());
    for (int i = 0; i < 4; i++)
    {
        int code = 0;
        switch (mapping)
        {
        case IIB::MAPPING_MEAN: bits.push_back(4 * x[i] > sum); break;
        case IIB::MAPPING_MAX: bits.push_back(x[i] == hi); break;
        case IIB::MAPPING_MIN: bits.push_back(x[i] == lo); break;
        case IIB::MAPPING_QUARTILE:
            code = 4 * (x[i] - lo) > 3 * (hi - lo) ? 3
                   : 2 * (x[i] - lo) > hi - lo     ? 2
                                                   : 4 * (x[i] - lo) > hi - lo;
            break;
        case IIB::MAPPING_SORT:
            for (int j = 0; j < 4; j++)
                code += x[j] < x[i] || (x[j] == x[i] && j < i);
            break;
        }
        if (mapping == IIB::MAPPING_QUARTILE || mapping == IIB::MAPPING_SORT)
            bits.insert(bits.end(), {(code & 2) != 0, (code & 1) != 0});
    }
    if (mapping == IIB::MAPPING_HAAR)
        return {x[0] + x[2] > x[1] + x[3], x[0] + x[1] > x[2] + x[3], x[0] + x[3] > x[1] + x[2]};
    if (mapping == IIB::MAPPING_PAIRWISE)
        return {x[0] > x[1], x[1] > x[3], x[3] > x[2], x[2] > x[0]};
    return bits;
}

std::vector<bool> quadBits(const IIB& iib, const Cells& cells, int channel, int level, int row, int col)
{
    const int n = 1 << level;
    const Quad q = {{cells(channel, n, row, col), cells(channel, n, row, col + 1),
            cells(channel, n, row + 1, col), cells(channel, n, row + 1, col + 1)}};
    return mapQuad(iib.getMapping(), comparable(q));
}

//! The bits of a level, of all quads or of the selection, in the descriptor's order.
std::vector<bool> levelBits(const IIB& iib, const Cells& cells, int channels, int level)
{
    std::vector<std::pair<uint64, bool>> bits;
    const auto add = [&](int channel, int row, int col, int mask) {
        const std::vector<bool> quad = quadBits(iib, cells, channel, level, row, col);
        for (int bit = 0; bit < (int)quad.size(); bit++)
        {
            uint64 place = 0;  // by group of channels, window, row, bit, column, channel
            for (int part : {channel / 4, row % 2 * 2 + col % 2, row, bit, col, channel})
                place = place << 10 | (uint64)part;
            if (mask >> bit & 1)
                bits.push_back({place, quad[bit]});
        }
    };
    const Mat_<int> selection = iib.getSelection();
    for (int i = 0; i < selection.rows; i++)
        if (selection(i, 0) == level)
            add(selection(i, 1), selection(i, 2), selection(i, 3), selection(i, 4));
    const int end = selection.empty() ? (1 << level) - 1 : 0, step = iib.getOverlap() ? 1 : 2;
    for (int row = 0; row < end; row += step)
        for (int col = 0; col < end; col += step)
            for (int channel = 0; channel < channels; channel++)
                add(channel, row, col, 255);
    std::sort(bits.begin(), bits.end());
    std::vector<bool> result;
    for (const auto& b : bits)
        result.push_back(b.second);
    return result;
}

void appendLevel(std::vector<uchar>& bytes, const std::vector<bool>& bits)
{
    const size_t start = bytes.size();
    bytes.resize(start + (bits.size() + 7) / 8, 0);
    for (size_t i = 0; i < bits.size(); i++)
        bytes[start + i / 8] |= (uchar)((int)bits[i] << i % 8);
}

//! Angle of a keypoint's description; -1: upright.
float angleOf(const IIB& iib, const Mat& grey, const KeyPoint& kp, size_t rank)
{
    if (iib.getOrientation() == IIB::ORIENTATION_GRADIENT && iib.getChannels() != 0)
        return prevailingAngle(iib, grey, kp, rank);
    return iib.getOrientation() == IIB::ORIENTATION_KEYPOINT && kp.angle >= 0 ? kp.angle : -1;
}

Cells cellsOf(const IIB& iib, const Mat& grey, const std::vector<Mat>& extra,
        const std::vector<Channel>& channels, const KeyPoint& kp, float angle)
{
    if (angle >= 0)
    {
        const RotatedRegion rotated(iib, grey, extra, kp, angle);
        return [rotated](int c, int n, int row, int col) { return rotated.cell(c, n, row, col); };
    }
    const SupportRegion ros(iib, kp);
    const bool reflect = iib.getBorder() == IIB::BORDER_REFLECT;
    return [ros, reflect, &channels](int c, int n, int row, int col) {
        return uprightCell(channels[c], ros, n, row, col, reflect);
    };
}

//! The channels in use, of a grey image (CV_8U or CV_16U) and of extra maps of these types.
std::vector<Channel> channelsOf(const IIB& iib, const Mat& grey, const std::vector<Mat>& extra)
{
    std::vector<Channel> channels;
    for (int y = 0; y < grey.rows; y++)
        for (int x = 0; x < grey.cols; x++)
        {
            const Point g = gradient(grey, y, x);
            const std::vector<int> v =
                    valuesOf(iib.getChannels(), grey, g, orientation(g.x, g.y), extra, y, x);
            while (channels.size() < v.size())
                channels.push_back(Channel(grey.size()));
            for (size_t c = 0; c < v.size(); c++)
                channels[c](y, x) = v[c];
        }
    return channels;
}

}  // namespace

Mat describe(const IIB& iib, const Mat& grey, const std::vector<Mat>& extra,
        const std::vector<KeyPoint>& keypoints)
{
    const std::vector<Channel> channels = channelsOf(iib, grey, extra);
    Mat descriptors;
    for (size_t k = 0; k < keypoints.size(); k++)
    {
        // of keypoints at the same place, the next one gets the next peak
        const size_t rank =
                std::count_if(keypoints.begin(), keypoints.begin() + k, [&](const KeyPoint& other) {
                    return other.pt == keypoints[k].pt && other.size == keypoints[k].size;
                });
        const float angle = angleOf(iib, grey, keypoints[k], rank);
        const Cells cells = cellsOf(iib, grey, extra, channels, keypoints[k], angle);
        std::vector<uchar> bytes;
        for (int level = 1; level <= iib.getGranularity(); level++)
            appendLevel(bytes, iib.getMapping() == IIB::MAPPING_BOXES
                                       ? boxLevelBits(iib, grey, keypoints[k], angle, level)
                                       : levelBits(iib, cells, (int)channels.size(), level));
        descriptors.push_back(Mat(bytes).reshape(1, 1).clone());
    }
    return descriptors;
}

}  // namespace oracle
