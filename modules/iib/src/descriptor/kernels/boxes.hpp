// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#pragma once

#include "kernels.hpp"

namespace cv { namespace iib {

/* MAPPING_BOXES: means over boxes on overlapping grids, from an integral image over squares of BOX_SQUARE x BOX_SQUARE pixels
 with BOX_LANES interleaved values: one vector or two hold a box's corner in all channels. Its RingRows count in squares. */

// Bits of a box in a channel, as in a selection's mask: those of MAPPING_HAAR, and comparisons among the box's own means.
static constexpr int BOX_HAAR_BITS = 3, BOX_HAAR_MASK = 7, BOX_FIRST_OWN_BIT = 8, BOX_SECOND_OWN_BIT = 16;

//! All bits of a box. @param kind of the channel, one of IIB::Channel.
inline int boxMask(int kind, int level, int row, int col)
{
    const int last = BOX_GRIDS[level - 1].n - 1;
    const int haar = row < last && col < last ? BOX_HAAR_MASK : 0;
    switch (kind)
    {
    case IIB::CHANNEL_SIGNED_GRAD_X:
    case IIB::CHANNEL_SIGNED_GRAD_Y: return haar | BOX_FIRST_OWN_BIT | BOX_SECOND_OWN_BIT;
    case IIB::CHANNEL_GRAD_X: return haar | BOX_FIRST_OWN_BIT;
    default: return haar;
    }
}

//! Sums of upright regions, and means of all regions.
enum BoxLane
{
    LANE_ABSOLUTE_X,
    LANE_ABSOLUTE_Y,
    LANE_GRADIENT_X,
    LANE_GRADIENT_Y,
    LANE_INTENSITY,
    LANE_GRADIENT_SUM,      //!< gx + gy
    LANE_GRADIENT_X_AGAIN,  //!< so that one vector comparison makes all bits of a box
    BOX_LANES = 8
};

//! Sums of rotated regions in place of the last two.
enum RotatedBoxLane
{
    LANE_ABSOLUTE_SUM = LANE_GRADIENT_SUM,             //!< |gx + gy|
    LANE_ABSOLUTE_DIFFERENCE = LANE_GRADIENT_X_AGAIN,  //!< |gx - gy|
};

enum
{
    BOX_SQUARE = 2,      //!< pixels along the side of a square
    BOX_PLANES = 3,      //!< gx, gy and intensity of a row of pixels
    BOX_MEAN_STEPS = 2,  //!< resolution of means: those of 8-bit images, and sums of two, fit 16 bits
    MAX_BOXES_IN_ROW = 9,
    BOXES_TOGETHER = 4,  //!< boxes in a row that kernels may process at a time
    MAX_BOX_STRIDE = (MAX_BOXES_IN_ROW + BOXES_TOGETHER - 1) / BOXES_TOGETHER * BOXES_TOGETHER,
    MAX_BOX_MEANS = (MAX_BOXES_IN_ROW * MAX_BOX_STRIDE + BOXES_TOGETHER) * BOX_LANES
};

/** n x n boxes. Means are in rows of stride() boxes. The boxes beyond n in a row, and BOXES_TOGETHER boxes behind the last
 row, are padding.

 Comparisons are bytes with a bit for each lane. For each row of quads there are 3 * quadBytes() bytes: for each bit of
 MAPPING_HAAR a byte for each quad. Then follows a byte for each mean, with |gx| > |gy|, gx > gy, gy > 0, gx + gy > 0 and
 gx > 0 in bits 0, 2, 3, 5 and 6. */
struct BoxGridShape
{
    int n;
    int first;  //!< its first place among those of all grids

    int stride() const { return (n + BOXES_TOGETHER - 1) / BOXES_TOGETHER * BOXES_TOGETHER; }
    int quadBytes() const { return (n - 1 + BOXES_TOGETHER - 1) / BOXES_TOGETHER * BOXES_TOGETHER; }
    int comparisonBytes() const { return 3 * (n - 1) * quadBytes() + n * stride(); }
};

static constexpr int MAX_BOX_COMPARISONS = 4 * MAX_BOXES_IN_ROW * MAX_BOX_STRIDE;

static constexpr int MAX_BOX_PLACES = 32;  //!< places of boxes along an axis, in all grids

//! Begins and ends of boxes in all grids of a keypoint. A box's weight is the product of its x and y weights.
struct BoxEdges
{
    int x[2][MAX_BOX_PLACES];  //!< offsets in a row of the integral image
    int y[2][MAX_BOX_PLACES];  //!< rows of the ring
    float xWeights[MAX_BOX_PLACES], yWeights[MAX_BOX_PLACES];
};

//! A keypoint's region, in squares.
struct BoxFrame
{
    Point2d centre;
    double side;
    Rect bounds;  //!< the squares that boxes may use
    int left;     //!< first column of the integral image
    int count;    //!< rows of its ring
    int shift;    //!< see RingRows
};

//! The boxes of a rotated keypoint.
struct BoxPlaces
{
    static constexpr int CAPACITY = MAX_BOXES_IN_ROW * MAX_BOXES_IN_ROW;
    int above[CAPACITY];  //!< top left corner in the integral image, in squares
    int below[CAPACITY];  //!< bottom left corner
    int right[CAPACITY];  //!< width in squares
    float weight[CAPACITY];
};

//! Kernels for pixels and means of type T. With short, sums must fit 32 bits.
template <typename T> struct BoxSumKernels
{
    typedef typename std::conditional<std::is_same<T, short>::value, unsigned, int64>::type Sum;

    /** For upright and for rotated regions: a row of the integral image from two rows of pixels. out = above + sums along
     the row; both begin left of the first square. @param rows with ROW_PADDING values more than the squares. */
    void (*sumRow[2])(const T* const rows[BOX_SQUARE][BOX_PLANES], int squares, const Sum* above, Sum* out);

    void (*means)(const RingRows<Sum>& integral, const BoxGridShape& grid, const BoxEdges& edges, T* means);

    //! mean = sum over j of matrix[j] * (box's sums * weight)[j], without the last lane.
    void (*rotatedMeans)(const RingRows<Sum>& integral, const BoxGridShape& grid, const BoxPlaces& places,
            const float matrix[BOX_LANES][BOX_LANES], T* means);

    //! Compares means, and writes the chosen comparisons.
    void (*bits)(const T* means, const BoxGridShape& grid, const ChosenBits& chosen, int offset,
            uchar* descriptor);
};

struct BoxKernels
{
    BoxSumKernels<short> shortSums;
    BoxSumKernels<int> longSums;
    const BoxSumKernels<short>& sums(short) const { return shortSums; }
    const BoxSumKernels<int>& sums(int) const { return longSums; }

    //! @param offsets of begins and ends from the region's centre, in units of its side.
    void (*edges)(const BoxFrame& frame, const double (&offsets)[2][MAX_BOX_PLACES], BoxEdges& edges);

    //! @param centres offsets of boxes' centres. @param direction cosine and sine. @param side of a box, in squares.
    void (*places)(const BoxFrame& frame, const BoxGridShape& grid, const double* centres, Point2d direction,
            double side, int step, BoxPlaces& places);
};

const BoxKernels& boxKernels();

}}  // namespace cv::iib
