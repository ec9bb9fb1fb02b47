// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#ifndef OPENCV_IIB_DESCRIPTOR_PLAN_HPP
#define OPENCV_IIB_DESCRIPTOR_PLAN_HPP

#include <memory>

#include "box_plan.hpp"
#include "kernels/kernels.hpp"

namespace cv {
namespace iib {

//! Up to GROUP_CHANNELS channels, which go through the kernels together.
struct ChannelGroup
{
    int first, count;                //!< which of the descriptor's channels
    std::vector<LevelShape> levels;  //!< [0] is not in use
};

/** All that follows from the parameters alone. Made when they change; never changes itself, so that any number of calls
 and threads share it. */
struct DescriptorPlan
{
    explicit DescriptorPlan(const Parameters& checked);

    //! Cells in a row at the finest level that has bits.
    int cellsInRow() const { return 1 << finest; }

    const Parameters parameters;
    const int finest;  //!< the finest level that has bits
    const std::vector<int> levelBytes;
    const int bytes;                       //!< of a descriptor
    std::vector<ChannelGroup> groups;      //!< of quads
    std::unique_ptr<const BoxPlan> boxes;  //!< of MAPPING_BOXES, which has no groups; else null
    const DescriptorKernels& kernels;
};

}  // namespace iib
}  // namespace cv

#endif
