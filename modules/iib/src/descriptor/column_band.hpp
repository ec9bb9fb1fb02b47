// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#ifndef OPENCV_IIB_DESCRIPTOR_COLUMN_BAND_HPP
#define OPENCV_IIB_DESCRIPTOR_COLUMN_BAND_HPP

#include "channels.hpp"

namespace cv {
namespace iib {

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
