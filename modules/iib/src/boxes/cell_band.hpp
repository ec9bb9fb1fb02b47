// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#ifndef OPENCV_IIB_BOXES_CELL_BAND_HPP
#define OPENCV_IIB_BOXES_CELL_BAND_HPP

#include "../descriptor/channels.hpp"

namespace cv {
namespace iib {

/** The last rows of an integral image over cells of BOX_CELL x BOX_CELL pixels, from the top of a rectangle of the image,
 reflected at its border, to its bottom. */
template <typename T, typename Sum> class CellBand
{
public:
    //! @param source gx, gy and intensity of the image; outlives the band, as do the kernels and the memory.
    //! @param area of whole cells. @param rows of pixels, how many, the newest included, a reader looks at.
    CellBand(const std::vector<Channel>& source, Rect area, int rows, const DescriptorKernels& kernels,
            typename SumCellRowFunc<T, Sum>::Type sumRow_, ScratchMemory& channelMemory,
            ScratchMemory& planeMemory, ScratchMemory& ringMemory)
        : channelRows(source, area, 0, kernels.pixels(T()).rows, channelMemory), sumRow(sumRow_),
          width(area.width / BOX_CELL),
          ring(area.tl() / BOX_CELL, std::min(rows / BOX_CELL + 2, area.height / BOX_CELL + 1),
                  ((size_t)width + 1) * BOX_LANES, BOX_LANES, ringMemory),
          planeStep(wholeLines<T>((size_t)area.width + ROW_PADDING)),
          planes(planeMemory.get<T>(BOX_PLANES * planeStep))
    {
    }

    //! Adds the image's rows up to and without `end`, which does not decrease from call to call.
    void advance(int end)
    {
        ring.advance(end / BOX_CELL, [&](int y, const Sum* above, Sum* out) {
            const T* rows[BOX_CELL][BOX_PLANES];
            for (int r = 0; r < BOX_CELL; r++)
            {
                std::copy_n(channelRows.compute(y * BOX_CELL + r), (int)BOX_PLANES, rows[r]);
                if (r == 0)
                    keepPlanes(rows[r]);
            }
            sumRow(rows, width, above, out);
        });
    }

    BoxIntegral<Sum> integral() const
    {
        const RingRows<Sum>& r = ring.rows();
        return BoxIntegral<Sum>{r.data, (int)r.step, r.count, r.origin};
    }

    //! The first row of cells whose sums are at hand.
    int oldest() const { return ring.oldest(); }

private:
    //! The planes are overwritten by those of the next row.
    void keepPlanes(const T* rowPlanes[BOX_PLANES])
    {
        for (int i = 0; i < BOX_PLANES; i++)
        {
            memcpy(planes + i * planeStep, rowPlanes[i], (size_t)width * BOX_CELL * sizeof(T));
            rowPlanes[i] = planes + i * planeStep;
        }
    }

    ChannelRows<T> channelRows;
    const typename SumCellRowFunc<T, Sum>::Type sumRow;
    const int width;  //!< in cells
    RowRing<Sum> ring;
    const size_t planeStep;
    T* const planes;
};

}  // namespace iib
}  // namespace cv

#endif
