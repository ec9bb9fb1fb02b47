// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#ifndef OPENCV_IIB_DESCRIPTOR_CELL_BAND_HPP
#define OPENCV_IIB_DESCRIPTOR_CELL_BAND_HPP

#include "channel_rows.hpp"

namespace cv {
namespace iib {

/** The last rows of an integral image over cells of BOX_CELL x BOX_CELL pixels. Goes from the top of a rectangle of the
 image, reflected at its border, to its bottom. Unlike in a ring, the distance of two corners of a box is the same for all
 keypoints. */
template <typename T, typename Sum> class CellBand
{
public:
    //! @param source gx, gy and intensity of the image; outlives the band, as do the kernels and the memory.
    //! @param area of whole cells. @param rows of pixels, how many, the newest included, a reader looks at.
    CellBand(const std::vector<Channel>& source, Rect area, int rows, const DescriptorKernels& kernels,
            typename SumCellRowFunc<T, Sum>::Type sumRow_, ScratchMemory& channelMemory,
            ScratchMemory& rowMemory, ScratchMemory& bandMemory)
        : channelRows(source, area, 0, kernels.pixels<T>().rows, channelMemory), sumRow(sumRow_),
          cells(area.x / BOX_CELL, area.y / BOX_CELL, area.width / BOX_CELL, area.height / BOX_CELL),
          kept(rows / BOX_CELL + 1), capacity(std::min(2 * kept, cells.height + 1)), top(cells.y),
          done(cells.y), rowStep(stepOf(cells.width)),
          planeStep(wholeLines<T>((size_t)area.width + ROW_PADDING)),
          planes(rowMemory.get<T>(BOX_PLANES * planeStep)),
          values(bandMemory.get<Sum>((size_t)rowStep * BOX_LANES * capacity))
    {
        std::fill(row(done), row(done) + (size_t)rowStep * BOX_LANES, (Sum)0);
    }

    //! Adds the image's rows up to and without `end`, which does not decrease from call to call.
    void advance(int end)
    {
        for (end /= BOX_CELL; done < end; done++)
        {
            if (done + 1 >= top + capacity)
                moveTop(done + 1 - kept);
            const T* rows[BOX_CELL][BOX_PLANES];
            for (int r = 0; r < BOX_CELL; r++)
            {
                channelRows.compute(done * BOX_CELL + r);
                for (int i = 0; i < BOX_PLANES; i++)
                    rows[r][i] = channelRows.plane(i);
                if (r == 0)
                    keepPlanes(rows[r]);
            }
            std::fill(row(done + 1), row(done + 1) + BOX_LANES, (Sum)0);
            sumRow(rows, cells.width, row(done), row(done + 1));
        }
    }

    //! Sums left of and above a cell, from cell origin() on, step() cells from row to row.
    const Sum* data() const { return values; }
    int step() const { return rowStep; }
    Point origin() const { return Point(cells.x, top); }

private:
    //! An odd number of cache lines: with an even one the corners of a column would share few cache sets.
    static int stepOf(int width)
    {
        const int inLine = std::max<int>(CACHE_LINE / (BOX_LANES * sizeof(Sum)), 1);
        return ((width + inLine) / inLine | 1) * inLine;
    }

    Sum* row(int y) { return values + (size_t)(y - top) * rowStep * BOX_LANES; }

    //! The planes are overwritten by those of the next row.
    void keepPlanes(const T* rowPlanes[BOX_PLANES])
    {
        for (int i = 0; i < BOX_PLANES; i++)
        {
            memcpy(planes + i * planeStep, rowPlanes[i], (size_t)cells.width * BOX_CELL * sizeof(T));
            rowPlanes[i] = planes + i * planeStep;
        }
    }

    void moveTop(int y)
    {
        memmove(values, row(y), (size_t)(done + 1 - y) * rowStep * BOX_LANES * sizeof(Sum));
        top = y;
    }

    ChannelRows<T> channelRows;
    const typename SumCellRowFunc<T, Sum>::Type sumRow;
    const Rect cells;
    const int kept, capacity;
    int top, done;  //!< rows at hand: [top, done]
    const int rowStep;
    const size_t planeStep;
    T* const planes;
    Sum* const values;
};

}  // namespace iib
}  // namespace cv

#endif
