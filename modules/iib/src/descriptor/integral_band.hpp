// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#ifndef OPENCV_IIB_DESCRIPTOR_INTEGRAL_BAND_HPP
#define OPENCV_IIB_DESCRIPTOR_INTEGRAL_BAND_HPP

#include "channel_rows.hpp"

namespace cv {
namespace iib {

/** Makes the rows of integral images of a group of channels, from the top of a rectangle of the image to its bottom. The
 ring stays in the cache while the keypoints that it holds are described. */
template <typename T, typename Sum> class IntegralBand
{
public:
    //! @param channels 1 to GROUP_CHANNELS; they, the kernels and the memory outlive the band.
    //! @param rows how many rows, the newest included, a reader looks at.
    IntegralBand(const std::vector<Channel>& channels, Rect area, int rows, const DescriptorKernels& kernels,
            ScratchMemory& rowMemory, ScratchMemory& ringMemory)
        : channelRows(channels, area, maxGradient(channels), kernels.pixels<T>().rows, rowMemory),
          width(area.width), done(area.y), sumRow(kernels.sumRow<T, Sum>()),
          sumCells(kernels.sums<Sum>().cells),
          longestPart((int)std::sqrt(
                  (double)std::numeric_limits<Sum>::max() / maxValue(channels, maxGradient(channels))))
    {
        view.step = rowBytes(area.width) / sizeof(Sum);
        view.count = rows;
        view.origin = area.tl();
        // Pixels begin on a cache line, behind the zeros to their left.
        const size_t margin = CACHE_LINE / sizeof(Sum);
        begin = ringMemory.get<Sum>(rows * view.step + margin) + margin - GROUP_CHANNELS;
        view.data = begin;
        std::fill(row(done), row(done) + view.step, (Sum)0);  // nothing is above the first row
        for (int i = 0; i < rows; i++)
            std::fill(row(done + i), row(done + i) + GROUP_CHANNELS, (Sum)0);  // nor left of the first pixel
    }

    //! Adds the image's rows up to and without y, area.y <= y <= area.y + area.height.
    void advance(int y)
    {
        for (; done < y; done++)
        {
            channelRows.compute(done);
            const T* planes[GROUP_CHANNELS];
            for (int i = 0; i < GROUP_CHANNELS; i++)
                planes[i] = channelRows.plane(i);
            sumRow(planes, width, row(done), row(done + 1));
        }
    }

    //! Sums over n x n cells, each of which a Sum must hold.
    void cells(const CellEdges& edges, int n, CellGrid<Sum>& sums) const
    {
        sumCells(view, edges.x, edges.y, n, sums);
    }

    //! Sums over larger cells: those over parts of them are added up.
    void cells(const CellEdges& edges, int n, CellGrid<double>& sums) const
    {
        sums.create(n);
        for (int r = 0; r < n; r++)
            for (int c = 0; c < n; c++)
            {
                double* const sum = sums.cell(r, c);
                std::fill_n(sum, (int)GROUP_CHANNELS, 0.);
                for (int y = edges.y[r]; y < edges.y[r + 1]; y += longestPart)
                    for (int x = edges.x[c]; x < edges.x[c + 1]; x += longestPart)
                        addPart(Range(x, std::min(x + longestPart, edges.x[c + 1])),
                                Range(y, std::min(y + longestPart, edges.y[r + 1])), sum);
            }
    }

private:
    static size_t rowBytes(int width)
    {
        const size_t bytes = ((size_t)width + 1 + ROW_PADDING) * GROUP_CHANNELS * sizeof(Sum);
        // An odd number of cache lines: with an even one the corners of a column would share few cache sets.
        return ((bytes + CACHE_LINE - 1) / CACHE_LINE | 1) * CACHE_LINE;
    }

    void addPart(Range x, Range y, double* sum) const
    {
        const Sum *const top = row(y.start), *const bottom = row(y.end);
        const size_t left = (size_t)(x.start - view.origin.x) * GROUP_CHANNELS,
                     right = (size_t)(x.end - view.origin.x) * GROUP_CHANNELS;
        for (int i = 0; i < GROUP_CHANNELS; i++)
            sum[i] += (Sum)(bottom[right + i] - bottom[left + i] - top[right + i] + top[left + i]);
    }

    Sum* row(int y) const { return begin + (y - view.origin.y) % view.count * view.step; }

    ChannelRows<T> channelRows;
    const int width;
    int done;  //!< rows of the image above this one are in the newest row
    const typename SumRowFunc<T, Sum>::Type sumRow;
    const typename SumKernels<Sum>::CellsFunc sumCells;
    const int longestPart;  //!< a Sum holds the sums over as many rows of as many pixels
    Sum* begin;
    IntegralRows<Sum> view;
};

}  // namespace iib
}  // namespace cv

#endif
