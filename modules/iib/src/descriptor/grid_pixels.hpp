// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#pragma once

#include <numeric>

#include "channels.hpp"
#include "keypoint_batches.hpp"
#include "plan.hpp"

namespace cv {
namespace iib {

/** The grid of points over a region.
@param n points in a row, up to MAX_SAMPLES_IN_ROW, `sub` x `sub` of them a cell. @param border one of IIB::Border. */
inline SampleGrid gridOf(
        const SupportRegion& region, const Rotation& rotation, int n, int sub, int border, Size image)
{
    SampleGrid g;
    g.n = n;
    g.sub = sub;
    g.image = image;
    g.reflect = circumscribed(region).bounds(image, border).size() != image;
    const double spacing = std::min(region.side, LARGEST_ROTATED_SIDE) / g.n;
    g.stepX = cvRound(rotation.cosine * spacing * 65536);
    g.stepY = cvRound(rotation.sine * spacing * 65536);
    const double far = 1 << 29;  // beyond any image
    const auto fixedPoint = [far](float v) {
        return (int64)std::floor(std::min(std::max((double)v, -far), far) * 131072 + 65536.5);
    };
    const int64 x = fixedPoint(region.centre.x), y = fixedPoint(region.centre.y);
    g.x = (int)(x >> 17);
    g.y = (int)(y >> 17);
    g.fracX = (int)(x & 131071);
    g.fracY = (int)(y & 131071);
    return g;
}

/** The last rows of GROUP_CHANNELS channels, side by side in each pixel, to be sampled anywhere. Goes from the top of a
 rectangle of the image to its bottom. */
template <typename T> class PixelBand
{
public:
    //! Pixels that a band keeps; a caller that cannot afford them samples without one.
    static double pixelsKept(Rect area, int rows) { return (double)rowStep(area) * capacityFor(area, rows); }

    //! @param channels 1 to GROUP_CHANNELS; they, the kernels and the memory outlive the band.
    //! @param rows how many rows, the newest included, a reader looks at.
    PixelBand(const std::vector<Channel>& channels, Rect area_, int rows, const PixelKernels<T>& kernels,
            ScratchMemory& rowMemory, ScratchMemory& pixelMemory)
        : channelRows(channels, area_, 0, kernels.rows, rowMemory), interleave(kernels.rotated.interleaveRow),
          area(area_), kept(rows), capacity(capacityFor(area_, rows)), top(area_.y), done(area_.y),
          pixelStep(rowStep(area_)), pixels(pixelMemory.get<T>((size_t)pixelStep * capacity * GROUP_CHANNELS))
    {
    }

    //! Makes the rows up to and without `end` of the image; `end` does not decrease from call to call.
    void advance(int end)
    {
        if (end > top + capacity)
            moveTop(std::max(end - kept, area.y));
        for (; done < end; done++)
            interleave(channelRows.compute(done), row(done), area.width);
    }

    //! Pixels at hand, from the first row on, step() pixels from row to row; the first one is at origin() in the image.
    const T* data() const { return pixels; }
    int step() const { return pixelStep; }
    Point origin() const { return Point(area.x, top); }

private:
    static int rowStep(Rect area) { return area.width + ROW_PADDING; }
    // Twice the rows that are kept: each row is then moved once at most.
    static int capacityFor(Rect area, int rows) { return (int)std::min<int64>(2 * (int64)rows, area.height); }

    T* row(int y) { return pixels + (size_t)(y - top) * pixelStep * GROUP_CHANNELS; }

    void moveTop(int y)
    {
        if (done > y)
            memmove(pixels, row(y), (size_t)(done - y) * pixelStep * GROUP_CHANNELS * sizeof(T));
        done = std::max(done, y);
        top = y;
    }

    ChannelRows<T> channelRows;
    void (*const interleave)(const T* const planes[GROUP_CHANNELS], T* out, int width);
    const Rect area;
    const int kept, capacity;
    int top, done;  //!< rows of the image at hand: [top, done)
    const int pixelStep;
    T* const pixels;
};

/** The samples of one keypoint read from the maps themselves, as pixels in the order of the places. For grids that touch
 few pixels of the area that they span. */
template <typename T> class SparsePixels
{
public:
    SparsePixels(const RotatedSampleKernels<T>& kernels_, ScratchMemory& memory)
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
        if (pack[0].kind == IIB::CHANNEL_SIGNED_GRAD_X)
            kernels.orientation(plane(0), plane(1), plane(2), count);
        const T* planes[GROUP_CHANNELS];
        for (int i = 0; i < GROUP_CHANNELS; i++)
            planes[i] = plane(std::min(i, (int)pack.size() - 1));
        kernels.interleaveRow(planes, plane(GROUP_CHANNELS), count);
        return plane(GROUP_CHANNELS);
    }

private:
    T* plane(int i) { return values + (size_t)i * (MAX_SAMPLES + ROW_PADDING); }

    //! A channel; with the horizontal gradient comes the vertical one, as the next plane. Sobel 3x3, where pixels beyond the
    //! image repeat its border.
    template <typename Pixel>
    void readPlane(const Channel& c, const int* x, const int* y, int count, int index)
    {
        const Mat& map = c.map;
        for (int s = 0; s < count; s++)
        {
            const int x0 = std::max(x[s] - 1, 0), x1 = x[s], x2 = std::min(x1 + 1, map.cols - 1);
            const Pixel *a = map.ptr<Pixel>(std::max(y[s] - 1, 0)), *m = map.ptr<Pixel>(y[s]),
                        *b = map.ptr<Pixel>(std::min(y[s] + 1, map.rows - 1));
            if (usesGradient(c))
            {
                plane(index)[s] = (T)((a[x2] - a[x0]) + 2 * (m[x2] - m[x0]) + (b[x2] - b[x0]));
                plane(index + 1)[s] = (T)((b[x0] - a[x0]) + 2 * (b[x1] - a[x1]) + (b[x2] - a[x2]));
            }
            else
                plane(index)[s] = (T)m[x1];
        }
    }

    const RotatedSampleKernels<T>& kernels;
    T* const values;
};

/* A row of pixels costs about a sixteenth of what as many samples cost that are read one by one. The limit keeps memory
 and indices small: a few large regions may span billions of pixels. */
inline bool isSparse(const KeyPointBatch& batch, double pixelsKept)
{
    const double samples = (double)batch.keypoints.size() * MAX_SAMPLES;
    return (double)batch.area.width * batch.area.height > 16 * samples || pixelsKept > 1 << 24;
}

//! The pixels of a batch at the points of one grid after another.
template <typename T> class GridPixels
{
public:
    GridPixels(const DescriptorKernels& all, const std::vector<std::vector<Channel>>& packs_,
            const KeyPointBatch& batch_, int border_, Workspace& workspace)
        : kernels(all.pixels(T())), packs(packs_), batch(batch_), border(border_), count(0),
          sparsePixels(kernels.rotated, workspace.sparsePixels)
    {
        const int rows = batch.rows + KeyPointBatch::BAND_ROWS;
        sparse = isSparse(batch, PixelBand<T>::pixelsKept(batch.area, rows));
        if (sparse)
            std::iota(index, index + MAX_SAMPLES, 0);
        for (size_t i = 0; !sparse && i < packs.size(); i++)
            bands.push_back(PixelBand<T>(
                    packs[i], batch.area, rows, kernels, workspace.sourceRows[i], workspace.sourcePixels[i]));
    }

    //! Moves on to a grid over this region. Regions come in the order of the batch, and each may have several grids.
    void moveTo(const SupportRegion& region, const SampleGrid& grid)
    {
        count = grid.n * grid.n;
        const int end = batch.bandEnd(rotatedPixels(region, border, grid.image).br().y);
        for (PixelBand<T>& band : bands)
            band.advance(end);
        if (sparse)
            kernels.rotated.places(grid, x, y);
        else
            kernels.rotated.indices(grid, bands[0].origin(), bands[0].step(), index);
    }

    //! Pixels of a pack, until the next call. Those at the points of the grid have these indices.
    const T* pixels(size_t pack)
    {
        return sparse ? sparsePixels.read(packs[pack], x, y, count) : bands[pack].data();
    }
    const int* indices() const { return index; }

private:
    const PixelKernels<T>& kernels;
    const std::vector<std::vector<Channel>>& packs;
    const KeyPointBatch& batch;
    const int border;
    bool sparse;
    int count;  //!< points of the grid
    SparsePixels<T> sparsePixels;
    std::vector<PixelBand<T>> bands;
    int index[MAX_SAMPLES], x[MAX_SAMPLES], y[MAX_SAMPLES];
};

}  // namespace iib
}  // namespace cv
