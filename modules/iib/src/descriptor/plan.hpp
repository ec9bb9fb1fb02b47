// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#pragma once

#include "boxes/plan.hpp"
#include "kernels/kernels.hpp"

namespace cv {
namespace iib {

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
    int finest;  //!< the finest level that has bits
    std::vector<int> levelBytes;
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

}  // namespace iib
}  // namespace cv
