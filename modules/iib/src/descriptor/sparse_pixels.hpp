// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#ifndef OPENCV_IIB_DESCRIPTOR_SPARSE_PIXELS_HPP
#define OPENCV_IIB_DESCRIPTOR_SPARSE_PIXELS_HPP

#include "channels.hpp"
#include "kernels/kernels.hpp"
#include "workspace.hpp"

namespace cv {
namespace iib {

//! One channel's values at a sample: pixels beyond the image repeat its border.
template <typename Pixel> struct Neighbourhood
{
    const Mat& map;
    int x0, x1, x2, y;

    Neighbourhood(const Mat& map_, int x, int y_)
        : map(map_), x0(std::max(x - 1, 0)), x1(x), x2(std::min(x + 1, map_.cols - 1)), y(y_)
    {
    }

    int centre() const { return map.ptr<Pixel>(y)[x1]; }

    //! Sobel 3x3.
    void gradient(int& gx, int& gy) const
    {
        const Pixel *a = map.ptr<Pixel>(std::max(y - 1, 0)), *m = map.ptr<Pixel>(y),
                    *b = map.ptr<Pixel>(std::min(y + 1, map.rows - 1));
        gx = (a[x2] - a[x0]) + 2 * (m[x2] - m[x0]) + (b[x2] - b[x0]);
        gy = (b[x0] - a[x0]) + 2 * (b[x1] - a[x1]) + (b[x2] - a[x2]);
    }
};

/** The samples of one keypoint read from the maps themselves, as pixels in the order of the places. For grids that touch
 few pixels of the area that they span. */
template <typename T> class SparsePixels
{
public:
    SparsePixels(const RowKernels<T>& kernels_, ScratchMemory& memory)
        : kernels(kernels_), values(memory.get<T>((size_t)(MAX_SAMPLES + ROW_PADDING) * 2 * GROUP_CHANNELS))
    {
    }

    //! @param x, y places in the maps, `count` of them. @return as many pixels of GROUP_CHANNELS values.
    const T* read(const std::vector<Channel>& pack, const int* x, const int* y, int count)
    {
        for (int i = 0; i < (int)pack.size(); i++)
            if (pack[i].kind != IIB::CHANNEL_SIGNED_GRAD_Y && pack[i].kind != IIB::CHANNEL_ORIENTATION)
            {
                if (pack[i].map.depth() == CV_8U)
                    readPlane<uchar>(pack[i], x, y, count, i);
                else
                    readPlane<ushort>(pack[i], x, y, count, i);
            }
        if (pack[0].kind != 0)
            kernels.orientation(plane(0), plane(1), plane(2), count);
        const T* planes[GROUP_CHANNELS];
        for (int i = 0; i < GROUP_CHANNELS; i++)
            planes[i] = plane(std::min(i, (int)pack.size() - 1));
        kernels.interleave(planes, plane(GROUP_CHANNELS), count);
        return plane(GROUP_CHANNELS);
    }

private:
    T* plane(int i) { return values + (size_t)i * (MAX_SAMPLES + ROW_PADDING); }

    //! A channel; with the horizontal gradient comes the vertical one, as the next plane.
    template <typename Pixel>
    void readPlane(const Channel& c, const int* x, const int* y, int count, int index)
    {
        for (int s = 0; s < count; s++)
        {
            const Neighbourhood<Pixel> around(c.map, x[s], y[s]);
            if (usesGradient(c))
            {
                int gx, gy;
                around.gradient(gx, gy);
                plane(index)[s] = (T)gx;
                plane(index + 1)[s] = (T)gy;
            }
            else
                plane(index)[s] = (T)around.centre();
        }
    }

    const RowKernels<T>& kernels;
    T* const values;
};

}  // namespace iib
}  // namespace cv

#endif
