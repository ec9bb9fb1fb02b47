// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#pragma once

#include "channels.hpp"
#include "keypoint_batches.hpp"
#include "plan.hpp"

namespace cv {
namespace iib {

/** Sums down the columns of the last rows of an image's channels. They are cheaper to make than integral images, and to add
 up where cells are narrow. */
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

//! Whether sums down the columns take less time than integral images: where cells are narrow, and keypoints are few.
inline bool columnsAreFaster(const DescriptorPlan& plan, const std::vector<Channel>& channels,
        const KeyPointBatch& batch, double side)
{
    const double pixelsOfKeyPoint = 256;  // so many make up for the longer time that a keypoint's cells take
    bool ofImage = maxGradient(channels) > 0;
    for (const Channel& c : channels)
        ofImage = ofImage && c.kind != 0;
    const int n = plan.cellsInRow();
    // 7 * (64.f / 7), the region of FAST's keypoints, is a little more than 64
    return plan.kernels.columnCells && ofImage && n % 8 == 0 && side <= NARROW_CELL * n * 1.000001 &&
           pixelsOfKeyPoint * (double)batch.keypoints.size() <= (double)batch.area.width * batch.area.height;
}

}  // namespace iib
}  // namespace cv
