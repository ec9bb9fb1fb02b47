// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#ifndef OPENCV_IIB_DESCRIPTOR_COLUMN_BAND_HPP
#define OPENCV_IIB_DESCRIPTOR_COLUMN_BAND_HPP

#include "channel_rows.hpp"

namespace cv {
namespace iib {

/** Makes the sums down the columns of a group of channels, row by row from the top of a rectangle of the image to its
 bottom, as IntegralBand makes integral images. */
class ColumnBand
{
public:
    //! @param channels 1 to GROUP_CHANNELS of the image; they, the kernels and the memory outlive the band.
    //! @param rows how many rows, the newest included, a reader looks at.
    ColumnBand(const std::vector<Channel>& channels, Rect area, int rows, const DescriptorKernels& kernels_,
            ScratchMemory& rowMemory, ScratchMemory& ringMemory)
        : channelRows(channels, area, maxGradient(channels), kernels_.pixels<short>().rows, rowMemory),
          kernels(kernels_), done(area.y)
    {
        // A cache line more: with four planes alone the rows of a column would share a quarter of the cache sets.
        view.step = channelRows.rowSize() + CACHE_LINE / sizeof(short);
        view.count = rows;
        view.origin = area.tl();
        for (int i = 0; i < GROUP_CHANNELS; i++)
            view.channels[i] = channelRows.place(i);
        ring = ringMemory.get<short>(rows * view.step + ROW_PADDING);
        view.data = reinterpret_cast<const ushort*>(ring);
        std::fill(row(done), row(done) + view.step, (short)0);  // nothing is above the first row
    }

    //! Adds the image's rows up to and without y, area.y <= y <= area.y + area.height.
    void advance(int y)
    {
        for (; done < y; done++)
            channelRows.add(done, row(done), row(done + 1));
    }

    //! Sums over n x n cells.
    void cells(const CellEdges& edges, int n, CellGrid<ushort>& sums) const
    {
        kernels.columnCells(view, edges.x, edges.y, n, sums);
    }

private:
    short* row(int y) { return ring + (y - view.origin.y) % view.count * view.step; }

    ChannelRows<short> channelRows;
    const DescriptorKernels& kernels;
    int done;  //!< rows of the image above this one are in the newest row
    short* ring;
    ColumnRows view;
};

}  // namespace iib
}  // namespace cv

#endif
