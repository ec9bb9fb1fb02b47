// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#ifndef OPENCV_IIB_DESCRIPTOR_BIT_ENCODER_HPP
#define OPENCV_IIB_DESCRIPTOR_BIT_ENCODER_HPP

#include "plan.hpp"

namespace cv {
namespace iib {

/** From the sums over the finest cells of a keypoint to the bits of one group of channels, level by level. Products of
 sums and weights are integers of 32 bits at the finest levels, as far as these surely fit, and doubles at the others. */
class BitEncoder
{
public:
    //! Memory that one thread uses again for each keypoint.
    struct Workspace
    {
        CellGrid<unsigned> sums[MAX_GRANULARITY];
        CellGrid<double> doubleSums[MAX_GRANULARITY + 1];
    };

    //! @param plan, group, workspace outlive the object. @param maxValue the largest value that is summed.
    BitEncoder(const DescriptorPlan& plan, const ChannelGroup& group, int maxValue, Workspace& workspace);

    /** Writes the bits of all levels into a descriptor; the groups before have written theirs.
     @param cells sums over the finest cells; Sum = ushort or unsigned.
     @param longestCell a bound of the difference of neighbouring edges. */
    template <typename Sum>
    void write(
            const CellGrid<Sum>& cells, const CellEdges& edges, double longestCell, uchar* descriptor) const;

    //! The same of sums that no unsigned holds.
    void write(const CellGrid<double>& cells, const CellEdges& edges, double, uchar* descriptor) const
    {
        writeDoubles(plan.finest, cells, edges, descriptor);
    }

private:
    //! The levels from `finest` on.
    void writeDoubles(
            int finest, const CellGrid<double>& cells, const CellEdges& edges, uchar* descriptor) const;

    const DescriptorPlan& plan;
    const ChannelGroup& group;
    const double largest;  //!< four times the largest value that is summed
    Workspace& workspace;
};

}  // namespace iib
}  // namespace cv

#endif
