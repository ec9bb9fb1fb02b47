// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#pragma once

#include "parameters.hpp"

namespace cv { namespace iib {

//! Which boxes and comparisons a descriptor of MAPPING_BOXES needs.
struct BoxPlan
{
    //! One that has any bit.
    struct Level
    {
        BoxGridShape shape;
        double side;                  //!< of a box, in sides of the region
        std::vector<double> centres;  //!< along either axis, in sides of the region from its centre
        int offset;                   //!< of the first bit in the descriptor
        ChosenBits chosen;
    };

    std::vector<Level> levels;
    //! Where boxes begin and end, in the unit of centres; unused entries are 0.
    double edges[2][MAX_BOX_PLACES];
    const BoxKernels& kernels;

    BoxPlan() : edges(), kernels(boxKernels()) {}
};

//! Up to GROUP_CHANNELS channels, which go through the kernels together.
struct ChannelGroup
{
    int first, count;                //!< which of the descriptor's channels
    std::vector<LevelShape> levels;  //!< [0] is not in use
};

//! All that follows from the parameters alone. It never changes, so that any number of calls and threads share it.
struct DescriptorPlan
{
    Parameters parameters;
    int finest;                        //!< the finest level that has bits
    std::vector<int> levelBytes;       //!< of each level that has any, coarse first
    int bytes;                         //!< of a descriptor
    std::vector<ChannelGroup> groups;  //!< of quads, unless isOfBoxes()
    BoxPlan boxes;                     //!< if isOfBoxes()
    const DescriptorKernels& kernels;

    bool isOfBoxes() const { return parameters.mapping == IIB::MAPPING_BOXES; }

    //! Cells in a row at the finest level that has bits.
    int cellsInRow() const { return 1 << finest; }
};

//! @param checked parameters that have passed their check().
Ptr<const DescriptorPlan> makePlan(const Parameters& checked);

//! Whether the keypoint's support region, upright or rotated, lies inside the image (compute.cpp).
bool isInside(const DescriptorPlan& plan, const KeyPoint& keypoint, Size image);

/** Describes keypoints (paper, algorithm 1; compute.cpp). All arguments are checked.
@param extra maps of the image's size.
@param descriptors keypoints.size() rows of plan.bytes, CV_8U, allocated. */
void describe(const DescriptorPlan& plan, const Mat& image, const std::vector<Mat>& extra,
        const std::vector<KeyPoint>& keypoints, Mat& descriptors);

}}  // namespace cv::iib
