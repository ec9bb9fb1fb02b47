// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#pragma once

#include "orientation.hpp"
#include "quads.hpp"

namespace cv { namespace iib {

/* What is compiled for each instruction set, as one table of functions. A pixel's value T is short for 8-bit images
 and int for 16-bit ones; a Sum is ushort or unsigned, modulo 2^16 or 2^32. */

constexpr int MAPPINGS = IIB::MAPPING_PAIRWISE + 1;  //!< of quads
constexpr int NARROW_CELL = 4;  //!< pixels; sums down the columns add up wider ones slowly

/** What a reader sees of the last rows of GROUP_CHANNELS channels, in a ring. Row (y - origin.y) % count holds the
 pixels of row y of the image, side by side; or the sums over its rows [origin.y, y): those of an integral image, side
 by side in each pixel, left of the pixels origin.x, origin.x + 1, ...; or those down the columns, a plane for each
 channel. A cell's sum, as the difference of its corners, is right if a Sum can hold it, however large the image. */
template <typename Sum> struct RingRows
{
    const Sum* data;
    size_t step;   //!< elements from row to row
    int count;     //!< rows in the ring
    Point origin;  //!< in the image

    //! Makes a row of the image an argument of place(): add this to its y. @param oldest the first row in the ring.
    int shift(int oldest) const { return (oldest - origin.y) % count - oldest; }

    static int place(int shifted, int count) { return shifted < count ? shifted : shifted - count; }
};

//! Three rows of an image. They begin one pixel left of those that are wanted and end one pixel right of them.
template <typename T> struct ImageRows
{
    const T *above, *middle, *below;
};

constexpr int IMAGE_PLANES = 6;  //!< the kinds of channels that an image has, in the order of IIB::Channel

//! The place of a kind in that order.
inline int planeOf(int kind)
{
    int place = 0;
    while (kind >> place > 1)
        place++;
    return place;
}

//! Where a row of each channel of an image goes; null for what is not wanted. Orientation is that of atan2(-gy, gx).
template <typename T> struct ImageChannelRows
{
    T* of[IMAGE_PLANES];
};

//! What a row of pixels goes through. Rows begin anywhere and have ROW_PADDING values more than `width`.
template <typename T> struct RowKernels
{
    /** Sobel 3x3.
     @param offset added to the gradients with signs.
     @param above if not 0, out[above + i] is added to out[i], modulo 2^16 or 2^32: the sums of the row above. */
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
    int x, y;          //!< pixel that holds the centre
    int fracX, fracY;  //!< the centre's place in it, in 2^-17 pixels
    int stepX, stepY;  //!< from point to point along a row, in 2^-16 pixels
    Size image;        //!< points beyond it get the nearest pixel of its border,
    bool reflect;      //!< or the one that BORDER_REFLECT_101 brings there

    //! Cells in a row.
    int cells() const { return n / sub; }
};

constexpr int MAX_SAMPLES_IN_ROW = 64;  //!< of a grid
constexpr int MAX_SAMPLES = MAX_SAMPLES_IN_ROW * MAX_SAMPLES_IN_ROW;

//! An angle, in 2^-12, and in ORIENTATION_STEPS a turn.
struct GradientRotation
{
    int cosine, sine, steps;
};

/* Points are ordered for sums over cells: first by the place within the cell, then by the cell's row, the parity of its
 column, and the column, as in a CellGrid. Sums are in planes, with cells in the same order. */
template <typename T> struct RotatedSampleKernels
{
    //! The places of the pixels nearest to the points among those of `rows`, of which `oldest` is the first at hand.
    void (*indices)(const SampleGrid& grid, const RingRows<T>& rows, int oldest, int* index);

    /** Rotates gradients: x' = c x + s y, y' = c y - s x, rounded. The orientation becomes (steps + its own) modulo
     ORIENTATION_STEPS, but 0 where there is no gradient, as upright.
     @param pixels gx, gy, orientation and intensity of each pixel.
     @param sums for each kind of channel; signed gradients without an offset. */
    void (*imageSums)(const T* pixels, const int* index, int cells, int samplesInCell,
            const GradientRotation& rotation, int* const sums[IMAGE_PLANES]);

    //! Magnitudes of gradients times weights, rounded. Arrays have ROW_PADDING values more than `count`.
    void (*gradientVotes)(const int* gx, const int* gy, const int* weights, int count, int* votes);

    //! Sums of four maps as they are.
    void (*mapSums)(
            const T* pixels, const int* index, int cells, int samplesInCell, int* const sums[GROUP_CHANNELS]);

    //! Four planes as a grid of cells, each with a number added.
    void (*interleave)(const int* const sums[GROUP_CHANNELS], const int addends[GROUP_CHANNELS], int cells,
            CellGrid<unsigned>& grid);

    //! Four planes of pixels side by side. They have ROW_PADDING values more than `width`.
    void (*interleaveRow)(const T* const planes[GROUP_CHANNELS], T* out, int width);
};

template <typename T> struct PixelKernels
{
    RowKernels<T> rows;
    RotatedSampleKernels<T> rotated;
};

template <typename T, typename Sum> struct IntegralKernels
{
    //! From a row of each channel: out = above + sums along the row; both begin left of the first pixel, with 0.
    void (*sumRow)(const T* const planes[GROUP_CHANNELS], int width, const Sum* above, Sum* out);

    //! Sums over n x n cells with the given edges, paddedEdges(n) and n + 1 of them, in pixels of the image.
    void (*cells)(
            const RingRows<Sum>& rows, const int* xEdges, const int* yEdges, int n, CellGrid<Sum>& cells);
};

//! For sums in double, all products and parent sums are doubles, else 32-bit integers, which they must fit.
template <typename Sum> struct BitsKernels
{
    typedef typename std::conditional<std::is_same<Sum, double>::value, double, unsigned>::type Parent;

    /** By mapping: write the bits of a level, in the order of doc/format.md.
     @param parents gets the sums over quads, which are the cells of the next coarser level. */
    void (*write[MAPPINGS])(const CellGrid<Sum>& cells, const LevelShape& shape, const CellEdges& edges,
            CellGrid<Parent>& parents, uchar* descriptor);

    //! The sums alone.
    void (*parentSums)(const CellGrid<Sum>& cells, CellGrid<Parent>& parents);
};

struct DescriptorKernels
{
    const char* instructionSet;  //!< for which they were compiled
    PixelKernels<short> shortPixels;
    PixelKernels<int> intPixels;
    IntegralKernels<short, ushort> shortIntegral;
    IntegralKernels<short, unsigned> longIntegral;
    IntegralKernels<int, unsigned> intIntegral;
    /** As shortIntegral.cells, from the sums down the columns, modulo 2^16. Null where it would be slow, as it is for
     cells wider than NARROW_CELL. May read ROW_PADDING values past the end of a row.
     @param channels where in a row each channel has its pixel origin.x. @param n a multiple of 8. */
    void (*columnCells)(const RingRows<short>& rows, const size_t channels[GROUP_CHANNELS], const int* xEdges,
            const int* yEdges, int n, CellGrid<ushort>& cells);
    BitsKernels<ushort> shortBits;
    BitsKernels<unsigned> longBits;
    BitsKernels<double> doubleBits;  //!< where 32-bit integers are too small

    //! The edges of n x n cells of a square with this top left corner and side, n a power of two, clamped to bounds.
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

//! Those for this machine, the fastest that cv::setUseOptimized and OPENCV_CPU_DISABLE allow.
const DescriptorKernels& descriptorKernels();

}}  // namespace cv::iib
