// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#pragma once

#include "kernels.hpp"

namespace cv { namespace iib {

/* MAPPING_BOXES: means over boxes on overlapping grids, from an integral image over squares of BOX_SQUARE x BOX_SQUARE pixels
 with BOX_LANES values side by side, so that one vector (or two) holds a corner of a box in all channels. RingRows of it
 count rows and columns in squares. */

// Bits of a box in a channel, as in a selection's mask: those of MAPPING_HAAR, and the comparisons of its own means.
static constexpr int BOX_HAAR_BITS = 3, BOX_HAAR_MASK = 7, BOX_FIRST_OWN_BIT = 8, BOX_SECOND_OWN_BIT = 16;

//! The bits that a box has. @param kind of the channel, one of IIB::Channel.
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

//! What is summed of upright regions, and compared of all.
enum BoxLane
{
    LANE_ABSOLUTE_X,
    LANE_ABSOLUTE_Y,
    LANE_GRADIENT_X,
    LANE_GRADIENT_Y,
    LANE_INTENSITY,
    LANE_GRADIENT_SUM,      //!< gx + gy
    LANE_GRADIENT_X_AGAIN,  //!< so that one comparison of a vector makes all bits of a box
    BOX_LANES = 8
};

//! What is summed of rotated regions in place of the last two.
enum RotatedBoxLane
{
    LANE_ABSOLUTE_SUM = LANE_GRADIENT_SUM,             //!< |gx + gy|
    LANE_ABSOLUTE_DIFFERENCE = LANE_GRADIENT_X_AGAIN,  //!< |gx - gy|
};

enum
{
    BOX_SQUARE = 2,      //!< pixels along the side of a square
    BOX_PLANES = 3,      //!< gx, gy and intensity of a row of pixels
    BOX_MEAN_STEPS = 2,  //!< to one in a square's sum: means of 8-bit images, and sums of two, fit 16 bits
    MAX_BOXES_IN_ROW = 9,
    BOXES_TOGETHER = 4,  //!< kernels may work on that many in a row at a time
    MAX_BOX_STRIDE = (MAX_BOXES_IN_ROW + BOXES_TOGETHER - 1) / BOXES_TOGETHER * BOXES_TOGETHER,
    MAX_BOX_MEANS = (MAX_BOXES_IN_ROW * MAX_BOX_STRIDE + BOXES_TOGETHER) * BOX_LANES
};

/** n x n boxes. Means are in rows of stride() boxes, of which the last ones mean nothing, as do BOXES_TOGETHER boxes
 behind the last row.

 Comparisons lie in memory as bytes, with a bit for each lane: for each row of quads three times quadBytes(), one for
 each bit of MAPPING_HAAR and in it a byte for each quad; then a byte for each mean, with |gx| > |gy|, gx > gy, gy > 0,
 gx + gy > 0 and gx > 0 in bits 0, 2, 3, 5 and 6. */
struct BoxGridShape
{
    int n;
    int first;  //!< of its n places among those of all grids

    int stride() const { return (n + BOXES_TOGETHER - 1) / BOXES_TOGETHER * BOXES_TOGETHER; }
    int quadBytes() const { return (n - 1 + BOXES_TOGETHER - 1) / BOXES_TOGETHER * BOXES_TOGETHER; }
    int comparisonBytes() const { return 3 * (n - 1) * quadBytes() + n * stride(); }
};

static constexpr int MAX_BOX_COMPARISONS = 4 * MAX_BOXES_IN_ROW * MAX_BOX_STRIDE;

static constexpr int MAX_BOX_PLACES = 32;  //!< of boxes along an axis, in all grids

//! Where boxes begin and end in all grids of a keypoint; the products of weights are those of boxes.
struct BoxEdges
{
    int x[2][MAX_BOX_PLACES];  //!< values from a row's beginning in the integral image
    int y[2][MAX_BOX_PLACES];  //!< rows of the ring
    float xWeights[MAX_BOX_PLACES], yWeights[MAX_BOX_PLACES];
};

//! A keypoint's region, in squares.
struct BoxFrame
{
    Point2d centre;
    double side;
    Rect bounds;  //!< the squares that count
    int left;     //!< column of the integral image that is its first
    int count;    //!< its rows in the ring, and
    int shift;    //!< where they are there, see RingRows
};

//! A box anywhere, as the boxes of a rotated keypoint are.
struct BoxPlaces
{
    static constexpr int CAPACITY = MAX_BOXES_IN_ROW * MAX_BOXES_IN_ROW;
    int above[CAPACITY];  //!< its top left corner in the integral image, in squares
    int below[CAPACITY];  //!< bottom left
    int right[CAPACITY];  //!< squares from there to the right corners
    float weight[CAPACITY];
};

/** Of pixels' values T, short or int: means are T as well, and sums unsigned, as long as 32 bits hold those of all
 boxes in 8-bit images, or 64-bit integers. */
template <typename T> struct BoxSumKernels
{
    typedef typename std::conditional<std::is_same<T, short>::value, unsigned, int64>::type Sum;

    /** Of upright and of rotated regions: a row of the integral image from two rows of pixels, out = above + sums along
     the row; both begin left of the first square. @param rows ROW_PADDING values longer than the squares. */
    void (*sumRow[2])(const T* const rows[BOX_SQUARE][BOX_PLANES], int squares, const Sum* above, Sum* out);

    void (*means)(const RingRows<Sum>& integral, const BoxGridShape& grid, const BoxEdges& edges, T* means);

    //! mean = sum over j of matrix[j] * (box's sums * weight)[j], without the last lane.
    void (*rotatedMeans)(const RingRows<Sum>& integral, const BoxGridShape& grid, const BoxPlaces& places,
            const float matrix[BOX_LANES][BOX_LANES], T* means);

    //! BoxGridShape::comparisonBytes() of them, of which the chosen ones are written.
    void (*bits)(const T* means, const BoxGridShape& grid, const ChosenBits& chosen, int offset,
            uchar* descriptor);
};

struct BoxKernels
{
    BoxSumKernels<short> shortSums;
    BoxSumKernels<int> longSums;
    const BoxSumKernels<short>& sums(short) const { return shortSums; }
    const BoxSumKernels<int>& sums(int) const { return longSums; }

    //! @param offsets of begins and ends from the region's centre, in its sides.
    void (*edges)(const BoxFrame& frame, const double (&offsets)[2][MAX_BOX_PLACES], BoxEdges& edges);

    //! @param centres of boxes from the region's, as offsets. @param direction cosine and sine. @param side in squares.
    void (*places)(const BoxFrame& frame, const BoxGridShape& grid, const double* centres, Point2d direction,
            double side, int step, BoxPlaces& places);
};

//! The kernels for this machine, as descriptorKernels() chooses them.
const BoxKernels& boxKernels();

}}  // namespace cv::iib
