// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#ifndef OPENCV_IIB_DESCRIPTOR_BANDS_HPP
#define OPENCV_IIB_DESCRIPTOR_BANDS_HPP

#include "channels.hpp"

namespace cv {
namespace iib {

//! The last rows of an integral image of a group of channels, from the top of a rectangle of the image to its bottom.
template <typename T, typename Sum> class IntegralBand
{
public:
    //! @param channels 1 to GROUP_CHANNELS; they, the kernels and the memory outlive the band.
    //! @param rows how many rows, the newest included, a reader looks at.
    IntegralBand(const std::vector<Channel>& channels, Rect area, int rows, const DescriptorKernels& kernels,
            ScratchMemory& rowMemory, ScratchMemory& ringMemory)
        : channelRows(channels, area, maxGradient(channels), kernels.pixels(T()).rows, rowMemory),
          ring(area.tl(), rows, ((size_t)area.width + 1 + ROW_PADDING) * GROUP_CHANNELS, GROUP_CHANNELS,
                  ringMemory),
          width(area.width), sumRow(kernels.sumRow(T(), Sum())), sumCells(kernels.sums(Sum()).cells),
          longestPart((int)std::sqrt(
                  (double)std::numeric_limits<Sum>::max() / maxValue(channels, maxGradient(channels))))
    {
    }

    //! Adds the image's rows up to and without y, area.y <= y <= area.y + area.height.
    void advance(int y)
    {
        ring.advance(y, [&](int row, const Sum* above, Sum* out) {
            sumRow(channelRows.compute(row), width, above, out);
        });
    }

    //! Sums over n x n cells, each of which a Sum must hold.
    void cells(const CellEdges& edges, int n, CellGrid<Sum>& sums) const
    {
        sumCells(ring.rows(), edges.x, edges.y, n, sums);
    }

    //! Sums over larger cells: those over parts of them are added up.
    void cells(const CellEdges& edges, int n, CellGrid<double>& sums) const
    {
        sums.create(n);
        for (int r = 0; r < n; r++)
            for (int c = 0; c < n; c++)
            {
                double* const sum = sums.cell(r, c);
                std::fill_n(sum, GROUP_CHANNELS, 0.);
                for (int y = edges.y[r]; y < edges.y[r + 1]; y += longestPart)
                    for (int x = edges.x[c]; x < edges.x[c + 1]; x += longestPart)
                        addPart(Range(x, std::min(x + longestPart, edges.x[c + 1])),
                                Range(y, std::min(y + longestPart, edges.y[r + 1])), sum);
            }
    }

private:
    void addPart(Range x, Range y, double* sum) const
    {
        const int first = ring.rows().origin.x;
        const Sum *const top = ring.row(y.start), *const bottom = ring.row(y.end);
        const size_t left = (size_t)(x.start - first) * GROUP_CHANNELS,
                     right = (size_t)(x.end - first) * GROUP_CHANNELS;
        for (int i = 0; i < GROUP_CHANNELS; i++)
            sum[i] += (Sum)(bottom[right + i] - bottom[left + i] - top[right + i] + top[left + i]);
    }

    ChannelRows<T> channelRows;
    RowRing<Sum> ring;
    const int width;
    const SumRowFunc<T, Sum> sumRow;
    const typename SumKernels<Sum>::CellsFunc sumCells;
    const int longestPart;  //!< a Sum holds the sums over as many rows of as many pixels
};

//! As IntegralBand, with sums down the columns alone: they are cheaper to make, and to add up where cells are narrow.
class ColumnBand
{
public:
    //! @param channels 1 to GROUP_CHANNELS of the image; they, the kernels and the memory outlive the band.
    //! @param rows how many rows, the newest included, a reader looks at.
    ColumnBand(const std::vector<Channel>& channels, Rect area, int rows, const DescriptorKernels& kernels_,
            ScratchMemory& rowMemory, ScratchMemory& ringMemory)
        : channelRows(channels, area, maxGradient(channels), kernels_.pixels(short()).rows, rowMemory),
          ring(area.tl(), rows, channelRows.rowSize() + ROW_PADDING, 0, ringMemory), kernels(kernels_)
    {
    }

    //! Adds the image's rows up to and without y, area.y <= y <= area.y + area.height.
    void advance(int y)
    {
        ring.advance(y, [&](int row, const short* above, short* out) { channelRows.add(row, above, out); });
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

}  // namespace iib
}  // namespace cv

#endif
