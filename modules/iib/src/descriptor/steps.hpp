// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#pragma once

#include "channels.hpp"
#include "keypoint_batches.hpp"
#include "plan.hpp"

namespace cv {
namespace iib {

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

/* The steps of describing keypoints, each in a source of its own. */

//! Whether the keypoint's support region, upright or rotated, lies inside the image.
bool isInside(const DescriptorPlan& plan, const KeyPoint& keypoint, Size image);

/** Describes keypoints by the other steps (paper, algorithm 1). All arguments have passed their checks.
@param extra maps of the image's size.
@param descriptors keypoints.size() rows of plan.bytes, CV_8U, allocated. */
void describe(const DescriptorPlan& plan, const Mat& image, const std::vector<Mat>& extra,
        const std::vector<KeyPoint>& keypoints, Mat& descriptors);

/** Sets the angles of regions as ORIENTATION_GRADIENT: the direction that prevails among the gradients between 32 x 32
 cells, each of which counts by its magnitude and by a Gaussian of half the region's radius around the centre.
@param grey CV_8U or CV_16U.
@param keypoints of the regions: of those with the same position and size, the second gets the second highest peak of
the directions, and so on. */
void findAngles(const DescriptorPlan& plan, const Mat& grey, const std::vector<KeyPoint>& keypoints,
        std::vector<SupportRegion>& regions);

//! The pixels that the boxes of a region cover, rotated by any angle or upright, in whole squares; some may be reflected.
Rect boxPixels(const SupportRegion& region, int border, Size image);

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

//! By sums over cells, where regions are upright.
void describeUpright(const BatchJob& job);

/** The same where regions are rotated. Integral images cannot serve, since |gx| does not rotate with the region: it is
 sampled on a grid of points, and the gradient is rotated at each. */
void describeRotated(const BatchJob& job);

/** By MAPPING_BOXES.

Upright boxes lie on a grid, whose edges many of them share. A rotated keypoint needs no samples: the means of gx and gy
are linear in them and so rotate as they do, and those of |gx| and |gy| come from the means of |gx|, |gy|, |gx + gy| and
|gx - gy|, that is, of the gradient's magnitude in four directions. Boxes stay upright; only their centres turn. */
void describeBoxes(const BatchJob& job);

}  // namespace iib
}  // namespace cv
