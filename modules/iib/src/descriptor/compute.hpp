// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#pragma once

#include "channels.hpp"
#include "keypoint_batches.hpp"
#include "plan.hpp"

namespace cv {
namespace iib {

//! Whether the keypoint's support region, upright or rotated, lies inside the image.
bool isInside(const DescriptorPlan& plan, const KeyPoint& keypoint, Size image);

/** Describes keypoints (paper, algorithm 1). All arguments have passed their checks.

@param extra maps of the image's size.
@param descriptors keypoints.size() rows of plan.bytes, CV_8U, allocated.
 */
void describe(const DescriptorPlan& plan, const Mat& image, const std::vector<Mat>& extra,
        const std::vector<KeyPoint>& keypoints, Mat& descriptors);

/** Sets the angles of regions as ORIENTATION_GRADIENT: the direction that prevails among the gradients between 32 x 32
 cells, each of which counts by its magnitude and by a Gaussian of half the region's radius around the centre.

@param grey CV_8U or CV_16U.
@param keypoints of the regions: of those with the same position and size, the second gets the second highest peak of the
directions, and so on. */
void findAngles(const DescriptorPlan& plan, const Mat& grey, const std::vector<KeyPoint>& keypoints,
        std::vector<SupportRegion>& regions);

/** The bits of the keypoints of a batch, all of whose regions are upright.

@param channels all channels of the descriptor.
@param regions of all keypoints of the image, as are the rows of descriptors. */
void describeUpright(const DescriptorPlan& plan, const std::vector<Channel>& channels,
        const KeyPointBatch& batch, const std::vector<SupportRegion>& regions, Workspace& workspace,
        Mat& descriptors);

/** The same where all are rotated by the keypoint's angle. Integral images cannot serve, since |gx| does not rotate with the
 region: it is sampled on a grid of points, and the gradient is rotated at each. */
void describeRotated(const DescriptorPlan& plan, const std::vector<Channel>& channels,
        const KeyPointBatch& batch, const std::vector<SupportRegion>& regions, Workspace& workspace,
        Mat& descriptors);

//! The pixels that the boxes of a region cover, rotated by any angle or upright, in whole cells; some may be reflected.
Rect boxPixels(const SupportRegion& region, int border, Size image);

/** The descriptors of a batch by MAPPING_BOXES, whose regions are all upright or all rotated.

Upright boxes lie on a grid, whose edges many of them share. A rotated keypoint needs no samples: the means of gx and gy
are linear in them and so rotate as they do, and those of |gx| and |gy| come from the means of |gx|, |gy|, |gx + gy| and
|gx - gy|, that is, of the gradient's magnitude in four directions. Boxes stay upright; only their centres turn.

@param grey the image, CV_8U or CV_16U.
@param regions of all keypoints, as are their boxPixels() and the rows of descriptors. */
void describeBoxes(const DescriptorPlan& plan, const Mat& grey, const KeyPointBatch& batch,
        const std::vector<SupportRegion>& regions, const std::vector<Rect>& pixels, Workspace& workspace,
        Mat& descriptors);

/** The bits of one group of channels, level by level, from the sums over the finest cells of a keypoint; the groups before
 have written theirs. Products of sums and weights are integers of 32 bits at the finest levels, as far as these surely fit,
 and doubles at the others.

@param cells of ushort, unsigned, or double where no unsigned holds the sums.
@param longestCell a bound of the difference of neighbouring edges.
@param maxValue the largest value that is summed. */
template <typename Sum>
void writeBits(const DescriptorPlan& plan, const ChannelGroup& group, const CellGrid<Sum>& cells,
        const CellEdges& edges, double longestCell, int maxValue, Workspace& workspace, uchar* descriptor);

}  // namespace iib
}  // namespace cv
