// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#include "box_oracle.hpp"

#include <algorithm>
#include <cmath>

#include "../../src/descriptor/rotation.hpp"

namespace oracle {

using namespace cv;
typedef cv::iib::IIBDescriptorExtractor IIB;

namespace {

//! MAPPING_BOXES as its table in descriptor.hpp.
const struct
{
    int n, side, reach;
} GRIDS[] = {{3, 32, 24}, {5, 24, 28}, {7, 16, 30}, {9, 9, 32}, {7, 6, 12}};

//! What boxes sum, pixel by pixel; the last two for rotation.
enum Value
{
    ABS_X,
    ABS_Y,
    GRAD_X,
    GRAD_Y,
    INTENSITY,
    ABS_SUM,
    ABS_DIFFERENCE,
    VALUES
};

int pixel(const Mat& m, int y, int x)
{
    y = std::min(std::max(y, 0), m.rows - 1);
    x = std::min(std::max(x, 0), m.cols - 1);
    return m.depth() == CV_8U ? m.at<uchar>(y, x) : m.at<ushort>(y, x);
}

int reflect(int v, int size)
{
    v = std::abs(v);
    return std::max(std::min(v, 2 * (size - 1) - v), 0);
}

void addPixel(const Mat& grey, int y, int x, int64 sums[VALUES])
{
    y = reflect(y, grey.rows);
    x = reflect(x, grey.cols);
    int gx = 0, gy = 0;
    for (int i = -1; i <= 1; i++)
    {
        gx += (2 - i * i) * (pixel(grey, y + i, x + 1) - pixel(grey, y + i, x - 1));
        gy += (2 - i * i) * (pixel(grey, y + 1, x + i) - pixel(grey, y - 1, x + i));
    }
    const int values[VALUES] = {
            std::abs(gx), std::abs(gy), gx, gy, pixel(grey, y, x), std::abs(gx + gy), std::abs(gx - gy)};
    for (int i = 0; i < VALUES; i++)
        sums[i] += values[i];
}

//! The edge of 2 x 2 pixels nearest to a position, within those that count. All in units of 2 pixels.
int edge(double position, int size, bool reflected)
{
    const double least = reflected ? std::floor((1 - size) / 2.) : 0,
                 most = std::ceil((reflected ? 2 * size - 1 : size) / 2.);
    return (int)std::min(std::max(std::floor(position + 0.5), least), most);
}

struct Box
{
    float mean[VALUES];  //!< sums weighted as if no pixel were missing
};

Box boxAt(const IIB& iib, const Mat& grey, double centreX, double centreY, double side)
{
    const bool reflected = iib.getBorder() == IIB::BORDER_REFLECT;
    const int x0 = edge(centreX - side / 2, grey.cols, reflected),
              x1 = edge(centreX - side / 2 + side, grey.cols, reflected);
    const int y0 = edge(centreY - side / 2, grey.rows, reflected),
              y1 = edge(centreY - side / 2 + side, grey.rows, reflected);
    int64 sums[VALUES] = {};
    for (int y = 2 * y0; y < 2 * y1; y++)
        for (int x = 2 * x0; x < 2 * x1; x++)
            addPixel(grey, y, x, sums);
    const float weight = (float)side * (float)side / ((float)(x1 - x0) * (float)(y1 - y0));
    Box box;
    for (int i = 0; i < VALUES; i++)
        box.mean[i] = (float)sums[i] * weight;
    return box;
}

//! The mean of |g| along a direction `turn` from that of x, from those at multiples of 45 degrees.
float along(const Box& b, double cos2, double sin2, double cos4)
{
    const double root = 0.70710678118654752;
    const float x = (float)((1 + cos4) / 4 + cos2 / 2), y = (float)((1 + cos4) / 4 - cos2 / 2),
                sum = (float)(((1 - cos4) / 4 + sin2 / 2) * root),
                difference = (float)(((1 - cos4) / 4 - sin2 / 2) * root);
    return x * b.mean[ABS_X] + y * b.mean[ABS_Y] + sum * b.mean[ABS_SUM] +
           difference * b.mean[ABS_DIFFERENCE];
}

void turn(Box& b, double cosine, double sine)
{
    const double cos2 = cosine * cosine - sine * sine, sin2 = 2 * sine * cosine,
                 cos4 = cos2 * cos2 - sin2 * sin2;
    const Box old = b;
    b.mean[ABS_X] = along(old, cos2, sin2, cos4);
    b.mean[ABS_Y] = along(old, -cos2, -sin2, cos4);
    b.mean[GRAD_X] = (float)cosine * old.mean[GRAD_X] + (float)sine * old.mean[GRAD_Y];
    b.mean[GRAD_Y] = (float)-sine * old.mean[GRAD_X] + (float)cosine * old.mean[GRAD_Y];
}

//! The channels in use as Values, in the order of CHANNEL_ values.
std::vector<int> valuesInUse(const IIB& iib)
{
    const std::pair<int, Value> kinds[] = {{IIB::CHANNEL_GRAD_X, ABS_X}, {IIB::CHANNEL_GRAD_Y, ABS_Y},
            {IIB::CHANNEL_INTENSITY, INTENSITY}, {IIB::CHANNEL_SIGNED_GRAD_X, GRAD_X},
            {IIB::CHANNEL_SIGNED_GRAD_Y, GRAD_Y}};
    std::vector<int> values;
    for (const auto& kind : kinds)
        if (iib.getChannels() & kind.first)
            values.push_back(kind.second);
    return values;
}

//! Bits 3 and 4, which are of one box: 1, 0, or -1 where there is no such bit.
int ownBit(const Box& b, int value, int bit)
{
    switch (value)
    {
    case ABS_X: return bit == 3 ? b.mean[ABS_X] > b.mean[ABS_Y] : -1;
    case GRAD_X: return bit == 3 ? b.mean[GRAD_X] > 0 : b.mean[GRAD_X] > b.mean[GRAD_Y];
    case GRAD_Y: return bit == 3 ? b.mean[GRAD_Y] > 0 : b.mean[GRAD_Y] > -b.mean[GRAD_X];
    default: return -1;
    }
}

//! Bits 0 to 2, of two by two boxes.
bool quadBit(const Box* const q[4], int value, int bit)
{
    const float a = q[0]->mean[value], b = q[1]->mean[value], c = q[2]->mean[value], d = q[3]->mean[value];
    return bit == 0 ? a + c > b + d : bit == 1 ? a + b > c + d : a + d > b + c;
}

bool isChosen(const Mat_<int>& selection, int level, int channel, int row, int col, int bit)
{
    for (int i = 0; i < selection.rows; i++)
        if (selection(i, 0) == level && selection(i, 1) == channel && selection(i, 2) == row &&
                selection(i, 3) == col)
            return (selection(i, 4) >> bit & 1) != 0;
    return selection.empty();
}

}  // namespace

std::vector<bool> boxLevelBits(const IIB& iib, const Mat& grey, const KeyPoint& kp, float angle, int level)
{
    const bool rotated = angle >= 0;
    const cv::iib::Rotation rotation(rotated ? angle : 0);  // ties depend on the last place
    const double cosine = rotation.cosine, sine = rotation.sine;
    const double regionSide =
            std::max((double)iib.getScaleFactor() * kp.size, (double)(1 << iib.getGranularity()));
    const int n = GRIDS[level - 1].n;
    const double side = std::max(std::floor(regionSide * GRIDS[level - 1].side / 160 + 0.5), 1.);
    std::vector<Box> boxes;
    for (int row = 0; row < n; row++)
        for (int col = 0; col < n; col++)
        {
            const double u = GRIDS[level - 1].reach * (2. * col / (n - 1) - 1) / 80,
                         v = GRIDS[level - 1].reach * (2. * row / (n - 1) - 1) / 80;
            const double c = cosine * (regionSide / 2), s = sine * (regionSide / 2);
            boxes.push_back(boxAt(iib, grey, (kp.pt.x + 0.5) / 2 + (c * u - s * v),
                    (kp.pt.y + 0.5) / 2 + (s * u + c * v), side));
            if (rotated)
                turn(boxes.back(), cosine, sine);
        }

    const std::vector<int> inUse = valuesInUse(iib);
    const Mat_<int> selection = iib.getSelection();
    std::vector<bool> bits;
    for (int first = 0; first < 5; first += 3)  // bits of quads, then of boxes
        for (int row = 0; row < n; row++)
            for (int col = 0; col < n; col++)
                for (int bit = first; bit < (first == 0 ? 3 : 5); bit++)
                    for (int value = 0; value <= INTENSITY; value++)
                    {
                        const auto channel = std::find(inUse.begin(), inUse.end(), value);
                        if (channel == inUse.end() ||
                                !isChosen(selection, level, (int)(channel - inUse.begin()), row, col, bit))
                            continue;
                        const Box* const b = &boxes[row * n + col];
                        if (first > 0)
                        {
                            if (ownBit(*b, value, bit) >= 0)
                                bits.push_back(ownBit(*b, value, bit) > 0);
                        }
                        else if (row + 1 < n && col + 1 < n)
                        {
                            const Box* const quad[] = {b, b + 1, b + n, b + n + 1};
                            bits.push_back(quadBit(quad, value, bit));
                        }
                    }
    return bits;
}

}  // namespace oracle
