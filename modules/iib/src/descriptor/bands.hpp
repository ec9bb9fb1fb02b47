// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#pragma once

#include "channels.hpp"

namespace cv { namespace iib {

/* Bands hold the last rows of something computed from the channels, so that they stay in the cache. */

//! Rows of sums, each computed from the row above it, in a ring that keeps the last ones.
template <typename Sum> class RowRing
{
public:
    /** @param origin the first row, which is all zeros, and the first column behind the zeros at its left.
     @param count number of rows that stay readable, including the newest.
     @param values in a row; the first `zeros` are always 0, and the next one begins a cache line. */
    RowRing(Point origin, int count, size_t values, size_t zeros, ScratchMemory& memory) : newest(origin.y)
    {
        const size_t inLine = CACHE_LINE / sizeof(Sum);
        // an odd number of cache lines, so that the corners of a column use many cache sets
        view.step = ((values + inLine - 1) / inLine | 1) * inLine;
        view.count = count;
        view.origin = origin;
        begin = memory.get<Sum>(count * view.step + inLine) + inLine - zeros;
        view.data = begin;
        std::fill(row(newest), row(newest) + view.step, (Sum)0);
        for (int i = 0; i < count; i++)
            std::fill(row(newest + i), row(newest + i) + zeros, (Sum)0);
    }

    //! Makes the rows after the newest one, up to row `last`: makeRow(y, row y, row y + 1) makes the latter.
    template <typename MakeRow> void advance(int last, const MakeRow& makeRow)
    {
        for (; newest < last; newest++)
            makeRow(newest, row(newest), row(newest + 1));
    }

    const RingRows<Sum>& rows() const { return view; }
    const Sum* row(int y) const { return begin + (size_t)((y - view.origin.y) % view.count) * view.step; }
    //! The oldest row in the ring.
    int oldest() const { return std::max(newest - view.count + 1, view.origin.y); }

private:
    Sum* row(int y) { return const_cast<Sum*>(static_cast<const RowRing*>(this)->row(y)); }

    int newest;
    Sum* begin;
    RingRows<Sum> view;
};

//! The last rows of an integral image of a group of channels, from the top of a rectangle of the image to its bottom.
template <typename T, typename Sum> class IntegralBand
{
public:
    //! @param channels 1 to GROUP_CHANNELS; they, the kernels and the memory outlive the band. @param bounds of them.
    //! @param rows number of rows that stay readable, including the newest.
    IntegralBand(const std::vector<Channel>& channels, const ChannelBounds& bounds, Rect area, int rows,
            const DescriptorKernels& all, ScratchMemory& rowMemory, ScratchMemory& ringMemory)
        : channelRows(channels, area, bounds.gradient, all.pixels(T()).rows, rowMemory),
          ring(area.tl(), rows, ((size_t)area.width + 1 + ROW_PADDING) * GROUP_CHANNELS, GROUP_CHANNELS,
                  ringMemory),
          width(area.width), kernels(all.integral(T(), Sum())),
          longestPart((int)std::sqrt((double)std::numeric_limits<Sum>::max() / bounds.value))
    {
    }

    //! Adds the image's rows before y, area.y <= y <= area.y + area.height.
    void advance(int y)
    {
        ring.advance(y, [&](int row, const Sum* above, Sum* out) {
            kernels.sumRow(channelRows.compute(row), width, above, out);
        });
    }

    //! Sums over n x n cells; each must fit a Sum.
    void cells(const CellEdges& edges, int n, CellGrid<Sum>& sums) const
    {
        kernels.cells(ring.rows(), edges.x, edges.y, n, sums);
    }

    //! Sums over larger cells, added up from parts.
    void cells(const CellEdges& edges, int n, CellGrid<double>& sums) const
    {
        sums.create(n);
        for (int r = 0; r < n; r++)
            for (int c = 0; c < n; c++)
            {
                double* const sum = sums.cell(r, c);
                std::fill_n(sum, GROUP_CHANNELS, 0.);
                for (int y = edges.y[r]; y < edges.y[r + 1]; y += longestPart)
                {
                    const Sum *const top = ring.row(y), *const bottom = ring.row(
                                                                std::min(y + longestPart, edges.y[r + 1]));
                    for (int x = edges.x[c]; x < edges.x[c + 1]; x += longestPart)
                    {
                        const size_t left = at(x), right = at(std::min(x + longestPart, edges.x[c + 1]));
                        for (int i = 0; i < GROUP_CHANNELS; i++)
                            sum[i] += (Sum)(bottom[right + i] - bottom[left + i] - top[right + i] +
                                            top[left + i]);
                    }
                }
            }
    }

private:
    size_t at(int x) const { return (size_t)(x - ring.rows().origin.x) * GROUP_CHANNELS; }

    ChannelRows<T> channelRows;
    RowRing<Sum> ring;
    const int width;
    const IntegralKernels<T, Sum>& kernels;
    const int longestPart;  //!< side of the largest square whose sum surely fits a Sum
};

/** Sums down the columns of the last rows of an image's channels. They are cheaper to make than integral images, and to
 add up where cells are narrow. */
class ColumnBand
{
public:
    //! The arguments are as IntegralBand has them; the channels are of the image, none is an extra one.
    ColumnBand(const std::vector<Channel>& channels, const ChannelBounds& bounds, Rect area, int rows,
            const DescriptorKernels& kernels_, ScratchMemory& rowMemory, ScratchMemory& ringMemory)
        : channelRows(channels, area, bounds.gradient, kernels_.pixels(short()).rows, rowMemory),
          ring(area.tl(), rows, channelRows.rowSize() + ROW_PADDING, 0, ringMemory), kernels(kernels_)
    {
    }

    //! Adds the image's rows before y, area.y <= y <= area.y + area.height.
    void advance(int y)
    {
        ring.advance(y,
                [&](int row, const short* above, short* out) { channelRows.compute(row, out, above - out); });
    }

    //! Sums over n x n cells.
    void cells(const CellEdges& edges, int n, CellGrid<ushort>& sums) const
    {
        kernels.columnCells(ring.rows(), channelRows.places(), edges.x, edges.y, n, sums);
    }

private:
    ChannelRows<short> channelRows;
    RowRing<short> ring;
    const DescriptorKernels& kernels;
};

}}  // namespace cv::iib
