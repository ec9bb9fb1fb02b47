// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#pragma once

#include "channels.hpp"
#include "keypoint_batches.hpp"
#include "plan.hpp"

namespace cv { namespace iib {

//! Memory that a thread reuses for each batch of keypoints. No batch reads what another has left there.
struct Workspace
{
    static constexpr int MAX_PACKS = 1 + (MAX_EXTRA_CHANNELS + GROUP_CHANNELS - 1) / GROUP_CHANNELS;

    ScratchMemory channelRows, ring;
    ScratchMemory sourceRows[MAX_PACKS], sourcePixels[MAX_PACKS], planes;  //!< of rotated regions
    CellGrid<ushort> shortSums;                                            //!< over the finest cells
    CellGrid<unsigned> sums[MAX_GRANULARITY + 1];                          //!< over the cells of each level
    CellGrid<double> doubleSums[MAX_GRANULARITY + 1];
    CellGrid<unsigned> samples;  //!< sums of rotated regions, over cells as fine as their grids
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

/** A batch of keypoints that are described together, and what that takes. Their regions are all upright or all rotated.
 Regions, pixels and rows of descriptors are those of all keypoints of the image. */
struct BatchJob
{
    const DescriptorPlan& plan;
    const Mat& grey;                       //!< the image, CV_8U or CV_16U
    const std::vector<Channel>& channels;  //!< all of the descriptor
    const std::vector<SupportRegion>& regions;
    const std::vector<Rect>& pixels;  //!< that each keypoint needs
    const KeyPointBatch& batch;
    Workspace& workspace;
    Mat& descriptors;
};

}}  // namespace cv::iib
