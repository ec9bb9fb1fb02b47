// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#ifndef OPENCV_IIB_DESCRIPTOR_GRID_PIXELS_HPP
#define OPENCV_IIB_DESCRIPTOR_GRID_PIXELS_HPP

#include <numeric>

#include "keypoint_batches.hpp"
#include "pixel_band.hpp"
#include "rotated_region.hpp"
#include "sparse_pixels.hpp"

namespace cv {
namespace iib {

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
        : kernels(all.pixels(T())), packs(packs_), batch(batch_), border(border_),
          sparsePixels(kernels.rows, workspace.sparsePixels)
    {
        const int rows = batch.rows + KeyPointBatch::BAND_ROWS;
        sparse = isSparse(batch, PixelBand<T>::pixelsKept(batch.area, rows));
        if (sparse)
            std::iota(index, index + MAX_SAMPLES, 0);
        for (size_t i = 0; !sparse && i < packs.size(); i++)
            bands.push_back(PixelBand<T>(packs[i], batch.area, rows, kernels.rows, workspace.sourceRows[i],
                    workspace.sourcePixels[i]));
    }

    //! The pixels at the points of a grid; they hold until the next call.
    class Points
    {
    public:
        //! @return an array of pixels of this pack; those of the grid are at index().
        const T* pixels(size_t pack) const
        {
            return owner.sparse ? owner.sparsePixels.read(owner.packs[pack], owner.x, owner.y, count)
                                : owner.bands[pack].data();
        }
        const int* index() const { return owner.index; }

    private:
        friend class GridPixels;
        Points(GridPixels& owner_, int count_) : owner(owner_), count(count_) {}

        GridPixels& owner;
        const int count;
    };

    //! @param grid over this region. Regions come in the order of the batch, and each may have several grids.
    Points at(const SupportRegion& region, Point2f centre, const SampleGrid& grid)
    {
        const int end = batch.bandEnd(rotatedPixels(region, centre, border, grid.image).br().y);
        for (PixelBand<T>& band : bands)
            band.advance(end);
        if (sparse)
            kernels.rotated.places(grid, x, y);
        else
            kernels.rotated.indices(grid, bands[0].origin(), bands[0].step(), index);
        return Points(*this, grid.n * grid.n);
    }

private:
    const PixelKernels<T>& kernels;
    const std::vector<std::vector<Channel>>& packs;
    const KeyPointBatch& batch;
    const int border;
    bool sparse;
    SparsePixels<T> sparsePixels;
    std::vector<PixelBand<T>> bands;
    int index[MAX_SAMPLES], x[MAX_SAMPLES], y[MAX_SAMPLES];
};

}  // namespace iib
}  // namespace cv

#endif
