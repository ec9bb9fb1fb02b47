// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#pragma once

#include "channels.hpp"
#include "keypoint_batches.hpp"
#include "plan.hpp"

namespace cv { namespace iib {

//! Memory that a thread reuses for each batch of keypoints. No batch reads the content of another.
struct Workspace
{
    static constexpr int MAX_PACKS = 1 + (MAX_EXTRA_CHANNELS + GROUP_CHANNELS - 1) / GROUP_CHANNELS;

    ScratchMemory channelRows, ring;
    ScratchMemory sourceRows[MAX_PACKS], sourcePixels[MAX_PACKS], planes;  //!< of rotated regions
    CellGrid<ushort> shortSums;                                            //!< over the finest cells
    CellGrid<unsigned> sums[MAX_GRANULARITY + 1];                          //!< over the cells of each level
    CellGrid<double> doubleSums[MAX_GRANULARITY + 1];
    CellGrid<unsigned> samples;  //!< sums of rotated regions, over the cells of their grids
    CellGrid<ushort>& sumsOf(ushort, int) { return shortSums; }
    CellGrid<unsigned>& sumsOf(unsigned, int level) { return sums[level]; }
    CellGrid<double>& sumsOf(double, int level) { return doubleSums[level]; }
    ScratchMemory boxMeans;
    BoxPlaces boxPlaces;
};

//! Calls work(job, workspace) for each of `count` jobs, in parallel.
template <typename Work> void parallelJobs(int count, const Work& work)
{
    parallel_for_(Range(0, count), [&](const Range& range) {
        Workspace workspace;
        for (int job = range.start; job < range.end; job++)
            work(job, workspace);
    });
}

/** Sets the angles of regions for ORIENTATION_GRADIENT: the peak of a histogram of gradient directions between 32 x 32
 cells, weighted by magnitude and by a Gaussian of half the region's radius.
@param grey CV_8U or CV_16U.
@param keypoints of the regions: of several with the same position and size, the second gets the second highest peak, and
so on. */
void findAngles(const DescriptorPlan& plan, const Mat& grey, const std::vector<KeyPoint>& keypoints,
        std::vector<SupportRegion>& regions);

/** A batch of keypoints that are described together, all upright or all rotated. Regions, pixels and rows of descriptors are
 those of all keypoints of the image. */
struct BatchJob
{
    const DescriptorPlan& plan;
    const Mat& grey;                       //!< the image, CV_8U or CV_16U
    const std::vector<Channel>& channels;  //!< all of the descriptor
    const std::vector<SupportRegion>& regions;
    const std::vector<Rect>& pixels;  //!< that each keypoint reads
    const KeyPointBatch& batch;
    Workspace& workspace;
    Mat& descriptors;
};

//! Describes upright regions by quads, from sums over cells (upright.cpp).
void describeUpright(const BatchJob& job);

//! Describes rotated regions by quads, from samples on rotated grids (rotated.cpp).
void describeRotated(const BatchJob& job);

/** Describes regions by MAPPING_BOXES (boxes.cpp).

Upright boxes lie on a grid, whose edges many of them share. Rotated keypoints need no samples. The means of gx and gy are
linear in gx and gy, so they rotate like them. The means of |gx| and |gy| are interpolated from those of |gx|, |gy|,
|gx + gy| and |gx - gy|, the gradient's magnitude in four directions. Boxes stay upright; only their centres rotate. */
void describeBoxes(const BatchJob& job);

//! The squares of an image that boxes may use (compute.cpp).
Rect boxBounds(int border, Size image);

}}  // namespace cv::iib
