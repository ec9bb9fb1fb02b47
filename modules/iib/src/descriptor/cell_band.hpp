// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#ifndef OPENCV_IIB_DESCRIPTOR_CELL_BAND_HPP
#define OPENCV_IIB_DESCRIPTOR_CELL_BAND_HPP

#include "channel_rows.hpp"

namespace cv {
namespace iib {

/** The last rows of an integral image over cells of BOX_CELL x BOX_CELL pixels, in a ring. Goes from the top of a rectangle
 of the image, reflected at its border, to its bottom. */
template <typename T, typename Sum> class CellBand
{
public:
    //! @param source gx, gy and intensity of the image; outlives the band, as do the kernels and the memory.
    //! @param area of whole cells. @param rows of pixels, how many, the newest included, a reader looks at.
    CellBand(const std::vector<Channel>& source, Rect area, int rows, const DescriptorKernels& kernels,
            typename SumCellRowFunc<T, Sum>::Type sumRow_, ScratchMemory& channelMemory,
            ScratchMemory& planeMemory, ScratchMemory& ringMemory)
        : channelRows(source, area, 0, kernels.pixels<T>().rows, channelMemory), sumRow(sumRow_),
          cells(area.x / BOX_CELL, area.y / BOX_CELL, area.width / BOX_CELL, area.height / BOX_CELL),
          done(cells.y), planeStep(wholeLines<T>((size_t)area.width + ROW_PADDING)),
          planes(planeMemory.get<T>(BOX_PLANES * planeStep))
    {
        view.step = stepOf(cells.width);
        view.count = std::min(rows / BOX_CELL + 2, cells.height + 1);
        view.origin = cells.tl();
        ring = ringMemory.get<Sum>((size_t)view.step * view.count);
        view.data = ring;
        std::fill(row(done), row(done) + view.step, (Sum)0);  // nothing is above the first row
        for (int i = 0; i < view.count; i++)
            std::fill(row(done + i), row(done + i) + BOX_LANES, (Sum)0);  // nor left of the first cell
    }

    //! Adds the image's rows up to and without `end`, which does not decrease from call to call.
    void advance(int end)
    {
        for (end /= BOX_CELL; done < end; done++)
        {
            const T* rows[BOX_CELL][BOX_PLANES];
            for (int r = 0; r < BOX_CELL; r++)
            {
                channelRows.compute(done * BOX_CELL + r);
                for (int i = 0; i < BOX_PLANES; i++)
                    rows[r][i] = channelRows.plane(i);
                if (r == 0)
                    keepPlanes(rows[r]);
            }
            sumRow(rows, cells.width, row(done), row(done + 1));
        }
    }

    const BoxIntegral<Sum>& integral() const { return view; }

    //! The first row of cells whose sums are at hand.
    int oldest() const { return std::max(done - view.count + 1, view.origin.y); }

private:
    //! An odd number of cache lines: with an even one the corners of a column would share few cache sets.
    static int stepOf(int width)
    {
        const int inLine = CACHE_LINE / sizeof(Sum);
        return (((width + 1) * BOX_LANES + inLine - 1) / inLine | 1) * inLine;
    }

    Sum* row(int y) { return ring + (size_t)((y - view.origin.y) % view.count) * view.step; }

    //! The planes are overwritten by those of the next row.
    void keepPlanes(const T* rowPlanes[BOX_PLANES])
    {
        for (int i = 0; i < BOX_PLANES; i++)
        {
            memcpy(planes + i * planeStep, rowPlanes[i], (size_t)cells.width * BOX_CELL * sizeof(T));
            rowPlanes[i] = planes + i * planeStep;
        }
    }

    ChannelRows<T> channelRows;
    const typename SumCellRowFunc<T, Sum>::Type sumRow;
    const Rect cells;
    int done;  //!< rows of cells above this one are in the newest row
    const size_t planeStep;
    T* const planes;
    Sum* ring;
    BoxIntegral<Sum> view;
};

}  // namespace iib
}  // namespace cv

#endif
