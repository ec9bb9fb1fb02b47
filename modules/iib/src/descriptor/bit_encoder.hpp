// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#ifndef OPENCV_IIB_DESCRIPTOR_BIT_ENCODER_HPP
#define OPENCV_IIB_DESCRIPTOR_BIT_ENCODER_HPP

#include "plan.hpp"

namespace cv {
namespace iib {

//! From the sums over the finest cells of a keypoint to the bits of one group of channels, level by level.
class BitEncoder
{
public:
    //! Memory that one thread uses again for each keypoint.
    struct Workspace
    {
        CellGrid<unsigned> sums[MAX_GRANULARITY + 1], centred;
        CellGrid<double> doubleSums[MAX_GRANULARITY + 1];
    };

    //! @param plan, group, workspace outlive the object. @param maxValue the largest value that is summed.
    BitEncoder(const DescriptorPlan& plan, const ChannelGroup& group, int maxValue, Workspace& workspace);

    /** Writes the bits of all levels into a descriptor; the groups before have written theirs.
     @param cells sums over the finest cells; Sum = ushort, unsigned or double.
     @param longestCell a bound of the difference of neighbouring edges. */
    template <typename Sum>
    void write(
            const CellGrid<Sum>& cells, const CellEdges& edges, double longestCell, uchar* descriptor) const
    {
        writeFrom(plan.finest, cells, edges, longestCell, descriptor);
    }

private:
    /** Writes a level and, from the sums of its cells, all coarser ones: in one call of a kernel as many as surely fit
     its integers.
     @param longest a bound of the lengths of this level's cells. */
    template <typename Sum>
    void writeFrom(int level, const CellGrid<Sum>& cells, const CellEdges& edges, double longest,
            uchar* descriptor) const;

    const DescriptorPlan& plan;
    const ChannelGroup& group;
    const double value;  //!< four times the largest that is summed
    Workspace& workspace;
};

template <>
void BitEncoder::writeFrom(int level, const CellGrid<double>& cells, const CellEdges& edges, double longest,
        uchar* descriptor) const;

}  // namespace iib
}  // namespace cv

#endif
