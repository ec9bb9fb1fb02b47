// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#include "descriptor_oracle.hpp"

#include <algorithm>
#include <cmath>

#include "../../src/descriptor/regions.hpp"

namespace oracle {

using namespace cv;
typedef cv::iib::IIBDescriptorExtractor IIB;

namespace {

//! MAPPING_BOXES as its table in doc/format.md.
const struct
{
    int n, side, reach;
} GRIDS[] = {{3, 32, 24}, {5, 24, 28}, {7, 16, 30}, {9, 8, 32}, {7, 6, 12}};

//! The values that boxes sum; the last two are for rotation.
enum Value
{
    ABS_X,
    ABS_Y,
    GRAD_X,
    GRAD_Y,
    INTENSITY,
    GRAD_SUM,
    ABS_SUM,
    ABS_DIFFERENCE,
    VALUES
};

void addPixel(const Mat& grey, int y, int x, int64 sums[VALUES])
{
    y = (int)reflectTo(y, grey.rows);
    x = (int)reflectTo(x, grey.cols);
    const Point g = gradient(grey, y, x);
    const int values[VALUES] = {std::abs(g.x), std::abs(g.y), g.x, g.y, pixel(grey, y, x), g.x + g.y,
            std::abs(g.x + g.y), std::abs(g.x - g.y)};
    for (int i = 0; i < VALUES; i++)
        sums[i] += values[i];
}

//! The nearest edge of 2 x 2 pixels, clamped, in units of 2 pixels.
int edge(double position, int size, int border)
{
    const bool reflected = border == IIB::BORDER_REFLECT;
    const double least = reflected ? std::floor((1 - size) / 2.) : 0,
                 most = border == IIB::BORDER_CLAMP ? std::max(std::floor(size / 2.), 1.)
                                                    : std::ceil((reflected ? 2 * size - 1 : size) / 2.);
    const double rounded = std::min(std::max(position + 0.5, least), most);
    return (int)(std::floor(rounded + (1 << 30)) - (1 << 30));  // to 2^-22: ties depend on it
}

struct Range1d
{
    int begin, end;

    int size() const { return std::max(end - begin, 1); }
};

//! The units of 2 pixels between two positions along an axis.
Range1d between(const IIB& iib, double begin, double end, int size)
{
    const Range1d range = {edge(begin, size, iib.getBorder()), edge(end, size, iib.getBorder())};
    return range;
}

struct Box
{
    float mean[VALUES];  //!< in halves of the sum over 2 x 2 pixels

    Box(const Mat& grey, Range1d xs, Range1d ys, bool rotated)
    {
        int64 sums[VALUES] = {};
        for (int y = 2 * ys.begin; y < 2 * ys.end; y++)
            for (int x = 2 * xs.begin; x < 2 * xs.end; x++)
                addPixel(grey, y, x, sums);
        for (int i = 0; i < VALUES; i++)
            mean[i] = rotated ? (float)sums[i] * (2.f / ((float)xs.size() * (float)ys.size()))
                              : (float)sums[i] * (1.f / (float)xs.size()) * (2.f / (float)ys.size());
    }

    void round()
    {
        for (float& m : mean)
            m = (float)cvRound(m);
    }
};

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
    const float x = old.mean[GRAD_X], y = old.mean[GRAD_Y];
    b.mean[ABS_X] = along(old, cos2, sin2, cos4);
    b.mean[ABS_Y] = along(old, -cos2, -sin2, cos4);
    b.mean[GRAD_X] = (float)cosine * x + (float)sine * y;
    b.mean[GRAD_Y] = (float)-sine * x + (float)cosine * y;
    b.mean[GRAD_SUM] = (float)(cosine - sine) * x + (float)(cosine + sine) * y;
}

/* Upright: between edges. Rotated: of a whole number of units, with a centre that turns.
 @param centre in units of 2 pixels, as is regionSide. */
Box boxAt(const IIB& iib, const Mat& grey, Point2d centre, double regionSide,
        const cv::iib::Rotation* rotation, int level, int row, int col)
{
    const int n = GRIDS[level - 1].n;
    const double reach = GRIDS[level - 1].reach, side = GRIDS[level - 1].side;
    if (!rotation)
    {
        // numerators are whole or halves, so that edges where boxes meet are equal
        const auto edges = [&](int i, double position, int size) {
            const double middle = 2 * reach * i - (n - 1) * reach, half = side * (n - 1) / 2;
            return between(iib, position + (middle - half) / (80 * (n - 1)) * regionSide,
                    position + (middle + half) / (80 * (n - 1)) * regionSide, size);
        };
        Box box(grey, edges(col, centre.x, grey.cols), edges(row, centre.y, grey.rows), false);
        box.round();
        return box;
    }
    const double u = reach * (2. * col / (n - 1) - 1) / 80, v = reach * (2. * row / (n - 1) - 1) / 80;
    const double c = rotation->cosine * regionSide, s = rotation->sine * regionSide;
    const double units = std::max(std::floor(regionSide * (side / 80) + 0.5), 1.);
    const double x = centre.x + (c * u - s * v) - units / 2, y = centre.y + (s * u + c * v) - units / 2;
    Box box(grey, between(iib, x, x + units, grey.cols), between(iib, y, y + units, grey.rows), true);
    turn(box, rotation->cosine, rotation->sine);
    box.round();
    return box;
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

//! Bits 3 and 4, from one box.
bool ownBit(const Box& b, int value, int bit)
{
    switch (value)
    {
    case ABS_X: return b.mean[ABS_X] > b.mean[ABS_Y];
    case GRAD_X: return bit == 3 ? b.mean[GRAD_X] > 0 : b.mean[GRAD_X] > b.mean[GRAD_Y];
    default: return bit == 3 ? b.mean[GRAD_Y] > 0 : b.mean[GRAD_SUM] > 0;
    }
}

//! Bits 0 to 2, from 2 x 2 boxes.
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
    const cv::iib::Rotation rotation(angle >= 0 ? angle : 0);  // ties depend on the last place
    const double regionSide =
            std::max((double)iib.getScaleFactor() * kp.size, (double)(1 << iib.getGranularity()));
    const Point2d centre((kp.pt.x + 0.5) / 2, (kp.pt.y + 0.5) / 2);
    const int n = GRIDS[level - 1].n;
    std::vector<Box> boxes;
    for (int row = 0; row < n; row++)
        for (int col = 0; col < n; col++)
            boxes.push_back(
                    boxAt(iib, grey, centre, regionSide / 2, angle >= 0 ? &rotation : 0, level, row, col));

    const std::vector<int> inUse = valuesInUse(iib);
    const Mat_<int> selection = iib.getSelection();
    const auto chosen = [&](int value, int row, int col, int bit) {
        const auto channel = std::find(inUse.begin(), inUse.end(), value);
        return channel != inUse.end() &&
               isChosen(selection, level, (int)(channel - inUse.begin()), row, col, bit);
    };
    std::vector<bool> bits;
    for (int row = 0; row + 1 < n; row++)
        for (int bit = 0; bit < 3; bit++)
            for (int col = 0; col + 1 < n; col++)
                for (int value = 0; value <= INTENSITY; value++)
                    if (chosen(value, row, col, bit))
                    {
                        const Box* const b = &boxes[row * n + col];
                        const Box* const quad[] = {b, b + 1, b + n, b + n + 1};
                        bits.push_back(quadBit(quad, value, bit));
                    }
    const struct
    {
        int value, bit;
    } own[] = {{ABS_X, 3}, {GRAD_X, 4}, {GRAD_Y, 3}, {GRAD_Y, 4}, {GRAD_X, 3}};
    for (int row = 0; row < n; row++)
        for (int col = 0; col < n; col++)
            for (const auto& o : own)
                if (chosen(o.value, row, col, o.bit))
                    bits.push_back(ownBit(boxes[row * n + col], o.value, o.bit));
    return bits;
}

}  // namespace oracle
