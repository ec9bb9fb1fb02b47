// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#pragma once

#include "bands.hpp"
#include "batch_job.hpp"

namespace cv { namespace iib {

//! The grid of points over a region. @param n points in a row, up to MAX_SAMPLES_IN_ROW; a cell has sub x sub.
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

//! The last rows of GROUP_CHANNELS channels over a rectangle of the image, interleaved.
template <typename T> class PixelBand
{
public:
    //! @param channels 1 to GROUP_CHANNELS; they, the kernels and the memory outlive the band.
    //! @param rows number of rows that stay readable, including the newest.
    PixelBand(const std::vector<Channel>& channels, Rect area, int rows, const PixelKernels<T>& kernels,
            ScratchMemory& rowMemory, ScratchMemory& pixelMemory)
        : channelRows(channels, area, 0, kernels.rows, rowMemory), interleave(kernels.rotated.interleaveRow),
          width(area.width),
          ring(area.tl() - Point(0, 1), rows, ((size_t)width + ROW_PADDING) * GROUP_CHANNELS, 0, pixelMemory)
    {
    }

    //! Makes the image's rows before `end`, which never decreases.
    void advance(int end)
    {
        ring.advance(end - 1,
                [&](int above, const T*, T* out) { interleave(channelRows.compute(above + 1), out, width); });
    }

    const RingRows<T>& rows() const { return ring.rows(); }

    //! The oldest row of the image in the ring.
    int oldest() const { return ring.oldest(); }

private:
    ChannelRows<T> channelRows;
    void (*const interleave)(const T* const planes[GROUP_CHANNELS], T* out, int width);
    const int width;
    RowRing<T> ring;
};

//! Copies the 3 x 3 pixels around each place side by side, with BORDER_REPLICATE.
template <typename Pixel>
void copyPatches(const Mat& map, const int* x, const int* y, int count, Mat& patches)
{
    patches.create(3, 3 * count, map.type());
    for (int row = 0; row < 3; row++)
    {
        Pixel* out = patches.ptr<Pixel>(row);
        for (int i = 0; i < count; i++, out += 3)
        {
            const Pixel* const in = map.ptr<Pixel>(std::min(std::max(y[i] + row - 1, 0), map.rows - 1));
            out[0] = in[std::max(x[i] - 1, 0)];
            out[1] = in[x[i]];
            out[2] = in[std::min(x[i] + 1, map.cols - 1)];
        }
    }
}

//! Whether maps of one size share their pixels.
inline bool isSame(const Mat& a, const Mat& b)
{
    return a.data == b.data && a.step == b.step && a.type() == b.type();
}

/* Whether to copy a patch around each point, not a band. A patch costs as much as about 16 pixels of a band. The limit on the
 band bounds memory and indices: a few large regions may span billions of pixels. */
inline bool isSparse(const KeyPointBatch& batch)
{
    const double samples = (double)batch.keypoints.size() * MAX_SAMPLES, width = batch.area.width;
    return width * batch.area.height > 16 * samples || width * batch.rows > 1 << 24;
}

//! The pixels at the points of one grid after another, from bands of the image or, if isSparse(), from patches.
template <typename T> class GridPixels
{
public:
    GridPixels(const DescriptorKernels& all, const std::vector<std::vector<Channel>>& packs_,
            const KeyPointBatch& batch_, Workspace& workspace_)
        : kernels(all.pixels(T())), packs(packs_), batch(batch_), sparse(isSparse(batch_)),
          workspace(workspace_)
    {
        if (!sparse)
            makeBands(packs, batch.area, batch.rows + KeyPointBatch::BAND_ROWS);
        for (size_t i = 0; sparse && i < packs.size(); i++)
        {
            patches.push_back(std::vector<Channel>());
            for (const Channel& c : packs[i])
                patches[i].push_back(Channel{c.kind, Mat()});
        }
    }

    //! Moves on to the grid of the next keypoint of the batch. @param pixels that it reads.
    void moveTo(const Rect& pixels, const SampleGrid& grid)
    {
        if (sparse)
            return moveToPatches(grid);
        for (PixelBand<T>& band : bands)
            band.advance(batch.bandEnd(pixels.br().y));
        kernels.rotated.indices(grid, bands[0].rows(), bands[0].oldest(), index);
    }

    //! Pixels of a pack, and the indices of the grid's points among them, until the next call of moveTo().
    const T* pixels(size_t pack) const { return bands[pack].rows().data; }
    const int* indices() const { return index; }

private:
    void makeBands(const std::vector<std::vector<Channel>>& sources, Rect area, int rows)
    {
        bands.clear();
        for (size_t i = 0; i < sources.size(); i++)
            bands.push_back(PixelBand<T>(
                    sources[i], area, rows, kernels, workspace.sourceRows[i], workspace.sourcePixels[i]));
    }

    void moveToPatches(const SampleGrid& grid)
    {
        const int count = grid.n * grid.n;
        int y[MAX_SAMPLES];
        RingRows<T> whole = {0, 0, INT_MAX, Point()};
        kernels.rotated.indices(grid, whole, 0, index);  // x
        whole.step = GROUP_CHANNELS;
        kernels.rotated.indices(grid, whole, 0, y);  // x + y
        for (int i = 0; i < count; i++)
            y[i] -= index[i];
        for (size_t pack = 0; pack < packs.size(); pack++)
            for (size_t i = 0; i < packs[pack].size(); i++)
            {
                const Mat& map = packs[pack][i].map;
                Mat& out = patches[pack][i].map;
                if (i > 0 && isSame(map, packs[pack][i - 1].map))
                    out = patches[pack][i - 1].map;
                else
                    (map.depth() == CV_8U ? copyPatches<uchar> : copyPatches<ushort>)(map, index, y, count,
                            out);
            }
        for (int i = 0; i < count; i++)
            index[i] = 3 * i + 1;
        makeBands(patches, Rect(0, 1, 3 * count, 1), 1);
        for (PixelBand<T>& band : bands)
            band.advance(2);
    }

    const PixelKernels<T>& kernels;
    const std::vector<std::vector<Channel>>& packs;
    const KeyPointBatch& batch;
    const bool sparse;
    Workspace& workspace;
    std::vector<std::vector<Channel>> patches;  //!< the packs around the points of one grid
    std::vector<PixelBand<T>> bands;
    int index[MAX_SAMPLES];
};

}}  // namespace cv::iib
