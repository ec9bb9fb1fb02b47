// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#pragma once

#include "orientation.hpp"
#include "quads.hpp"

namespace cv { namespace iib {

/* The functions that are compiled for each instruction set. A pixel's value T is short for 8-bit images and int for 16-bit
 ones; a Sum is ushort or unsigned, modulo 2^16 or 2^32. */

constexpr int MAPPINGS = IIB::MAPPING_PAIRWISE + 1;  //!< of quads
constexpr int NARROW_CELL = 4;  //!< pixels; for wider cells, sums down the columns are slow

/** A ring with the last rows of GROUP_CHANNELS channels. Row (y - origin.y) % count holds one of
 - the pixels of row y of the image, interleaved;
 - the sums over rows [origin.y, y) of an integral image, interleaved, left of the pixels origin.x, origin.x + 1, ...;
 - the sums over these rows down each column, a plane for each channel.
 A cell's sum, as a difference of corners, is right if it fits a Sum, even if the corners overflow. */
template <typename Sum> struct RingRows
{
    const Sum* data;
    size_t step;   //!< elements from row to row
    int count;     //!< rows in the ring
    Point origin;  //!< in the image

    //! place(y + shift, count) is the place of row y. @param oldest the oldest row in the ring.
    int shift(int oldest) const { return (oldest - origin.y) % count - oldest; }

    static int place(int shifted, int count) { return shifted < count ? shifted : shifted - count; }
};

//! Three rows of an image, one pixel longer at either end than the output.
template <typename T> struct ImageRows
{
    const T *above, *middle, *below;
};

constexpr int IMAGE_PLANES = 6;  //!< channels of an image, in the order of IIB::Channel

//! The place of a channel's kind in this order.
inline int planeOf(int kind)
{
    int place = 0;
    while (kind >> place > 1)
        place++;
    return place;
}

//! Output rows for each channel of an image; null: not needed. Orientation is atan2(-gy, gx).
template <typename T> struct ImageChannelRows
{
    T* of[IMAGE_PLANES];
};

//! Kernels for a row of pixels. Rows need no alignment and have ROW_PADDING values more than `width`.
template <typename T> struct RowKernels
{
    /** Sobel 3x3.
     @param offset added to signed gradients.
     @param above if not 0, out[above + i] is added to out[i], modulo 2^16 or 2^32. */
    void (*imageChannels)(
            const ImageRows<T>& rows, T offset, const ImageChannelRows<T>& out, ptrdiff_t above, int width);
    void (*widen8u)(const uchar* in, T* out, int width);
    void (*widen16u)(const ushort* in, T* out, int width);
};

/** The nearest pixels to a square grid of points, rotated by an angle. Grid point (row, col) of n x n is at
 (x, y) + (u stepX - v stepY, u stepY + v stepX) / 2 with u = 2 col + 1 - n and v = 2 row + 1 - n. */
struct SampleGrid
{
    int n;             //!< points in a row
    int sub;           //!< a cell has sub x sub points
    int x, y;          //!< pixel of the centre
    int fracX, fracY;  //!< the centre's place in it, in 2^-17 pixels
    int stepX, stepY;  //!< from point to point along a row, in 2^-16 pixels
    Size image;
    bool reflect;  //!< points outside the image: BORDER_REFLECT_101, else BORDER_REPLICATE

    //! Cells in a row.
    int cells() const { return n / sub; }
};

constexpr int MAX_SAMPLES_IN_ROW = 64;  //!< of a grid
constexpr int MAX_SAMPLES = MAX_SAMPLES_IN_ROW * MAX_SAMPLES_IN_ROW;

//! Cosine and sine in 2^-12, and the angle in 1/ORIENTATION_STEPS of a turn.
struct GradientRotation
{
    int cosine, sine, steps;
};

/* Points are sorted by the place within the cell, then by the cell's row, the parity of its column, and the column, as in a
 CellGrid. Sums are in planes, with cells in the same order. */
template <typename T> struct RotatedSampleKernels
{
    //! The indices in `rows` of the pixels nearest to the points. @param oldest the oldest row in the ring.
    void (*indices)(const SampleGrid& grid, const RingRows<T>& rows, int oldest, int* index);

    /** Rotates gradients, x' = c x + s y, y' = c y - s x, rounded, and sums them over cells. The rotation's steps are added
     to the orientation, modulo ORIENTATION_STEPS, except where there is no gradient.
     @param pixels gx, gy, orientation and intensity of each pixel.
     @param sums for each kind of channel; signed gradients without an offset. */
    void (*imageSums)(const T* pixels, const int* index, int cells, int samplesInCell,
            const GradientRotation& rotation, int* const sums[IMAGE_PLANES]);

    //! Gradient magnitudes times weights, rounded. Arrays have ROW_PADDING values more than `count`.
    void (*gradientVotes)(const int* gx, const int* gy, const int* weights, int count, int* votes);

    //! Sums of four maps.
    void (*mapSums)(
            const T* pixels, const int* index, int cells, int samplesInCell, int* const sums[GROUP_CHANNELS]);

    //! Interleaves four planes to a grid of cells, and adds a number to each plane.
    void (*interleave)(const int* const sums[GROUP_CHANNELS], const int addends[GROUP_CHANNELS], int cells,
            CellGrid<unsigned>& grid);

    //! Interleaves four planes of pixels, which have ROW_PADDING values more than `width`.
    void (*interleaveRow)(const T* const planes[GROUP_CHANNELS], T* out, int width);
};

template <typename T> struct PixelKernels
{
    RowKernels<T> rows;
    RotatedSampleKernels<T> rotated;
};

template <typename T, typename Sum> struct IntegralKernels
{
    //! out = above + sums along a row of each channel; both begin left of the first pixel, with 0.
    void (*sumRow)(const T* const planes[GROUP_CHANNELS], int width, const Sum* above, Sum* out);

    //! Sums over n x n cells with paddedEdges(n) edges along x and n + 1 along y, in pixels of the image.
    void (*cells)(
            const RingRows<Sum>& rows, const int* xEdges, const int* yEdges, int n, CellGrid<Sum>& cells);
};

//! Products and parent sums are doubles for sums of type double, else 32-bit integers, which they must fit.
template <typename Sum> struct BitsKernels
{
    typedef typename std::conditional<std::is_same<Sum, double>::value, double, unsigned>::type Parent;

    /** By mapping: write the bits of a level, in the order of doc/format.md.
     @param parents gets the sums over quads, which are the cells of the next coarser level. */
    void (*write[MAPPINGS])(const CellGrid<Sum>& cells, const LevelShape& shape, const CellEdges& edges,
            CellGrid<Parent>& parents, uchar* descriptor);

    //! The parent sums alone.
    void (*parentSums)(const CellGrid<Sum>& cells, CellGrid<Parent>& parents);
};

struct DescriptorKernels
{
    const char* instructionSet;
    PixelKernels<short> shortPixels;
    PixelKernels<int> intPixels;
    IntegralKernels<short, ushort> shortIntegral;
    IntegralKernels<short, unsigned> longIntegral;
    IntegralKernels<int, unsigned> intIntegral;
    /** As shortIntegral.cells, from sums down the columns, modulo 2^16. Null if it would be slow; slow for cells wider than
     NARROW_CELL. May read ROW_PADDING values past the end of a row.
     @param channels place of pixel origin.x in a row, for each channel. @param n a multiple of 8. */
    void (*columnCells)(const RingRows<short>& rows, const size_t channels[GROUP_CHANNELS], const int* xEdges,
            const int* yEdges, int n, CellGrid<ushort>& cells);
    BitsKernels<ushort> shortBits;
    BitsKernels<unsigned> longBits;
    BitsKernels<double> doubleBits;  //!< where 32-bit integers are too small

    //! The edges of n x n cells of a square, clamped to bounds; n is a power of two.
    void (*cellEdges)(Point2d corner, double side, int n, Rect bounds, CellEdges& edges);

    const PixelKernels<short>& pixels(short) const { return shortPixels; }
    const PixelKernels<int>& pixels(int) const { return intPixels; }
    const BitsKernels<ushort>& bits(ushort) const { return shortBits; }
    const BitsKernels<unsigned>& bits(unsigned) const { return longBits; }
    const BitsKernels<double>& bits(double) const { return doubleBits; }
    const IntegralKernels<short, ushort>& integral(short, ushort) const { return shortIntegral; }
    const IntegralKernels<short, unsigned>& integral(short, unsigned) const { return longIntegral; }
    const IntegralKernels<int, unsigned>& integral(int, unsigned) const { return intIntegral; }
};

//! The fastest kernels that this machine, cv::setUseOptimized and OPENCV_CPU_DISABLE allow.
const DescriptorKernels& descriptorKernels();

}}  // namespace cv::iib
