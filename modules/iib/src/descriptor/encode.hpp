// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#pragma once

#include "steps.hpp"

namespace cv {
namespace iib {

template <typename Cell> void widen(const CellGrid<Cell>& cells, CellGrid<double>& wide)
{
    wide.create(cells.size());
    for (int r = 0; r < cells.size(); r++)
        for (int parity = 0; parity < 2; parity++)
            std::copy_n(cells.row(r, parity), cells.size() / 2 * GROUP_CHANNELS, wide.row(r, parity));
}

//! The largest factor by which Weights multiplies a sum, along one axis.
inline double largestWeight(const Axis& axis, int n)
{
    int smallest = INT_MAX, largest = 0;
    for (int i = 0; i < n; i++)
    {
        smallest = std::min(smallest, axis.length(i));
        largest = std::max(largest, axis.length(i));
    }
    return smallest == largest ? 1 : largest;
}

inline double largestWeight(const LevelShape& shape, const CellEdges& edges)
{
    const Axis x = {edges.x, shape.step}, y = {edges.y, shape.step};
    return largestWeight(x, shape.n) * largestWeight(y, shape.n);
}

//! The bits of a group of channels of one keypoint, where the values of a pixel of four cells sum up to `largest` at most.
struct LevelWriter
{
    const DescriptorPlan& plan;
    const ChannelGroup& group;
    const CellEdges& edges;
    const double largest;
    Workspace& workspace;
    uchar* const descriptor;

    //! Whether the largest weighted sum of a level surely fits an int, where no cell is longer than `longest`.
    bool fitsInt(int level, double longest) const
    {
        const double sum = largest * longest * longest, area = longest * longest;
        return sum * area <= INT_MAX || sum * largestWeight(group.levels[level], edges) <= INT_MAX;
    }

    //! A level and all coarser ones.
    template <typename Sum> void write(int level, const CellGrid<Sum>& cells, double longest) const
    {
        auto& parents = workspace.sumsOf(typename BitsKernels<Sum>::Parent(), level - 1);
        plan.kernels.bits(Sum()).write[plan.parameters.mapping](
                cells, group.levels[level], edges, parents, descriptor);
        if (level > 1)
            writeFitting(level - 1, parents, 2 * longest);
    }

    //! The same, in doubles where integers are too small.
    template <typename Sum> void writeFitting(int level, const CellGrid<Sum>& cells, double longest) const
    {
        if (fitsInt(level, longest))
            return write(level, cells, longest);
        CellGrid<double>& wide = workspace.sumsOf(double(), level);
        widen(cells, wide);
        write(level, wide, longest);
    }
    void writeFitting(int level, const CellGrid<double>& cells, double longest) const
    {
        write(level, cells, longest);
    }
};

/** The bits of one group of channels, level by level, from the sums over the finest cells of a keypoint; the groups before
 have written theirs. Products of sums and weights are integers of 32 bits at the finest levels, as far as these surely fit,
 and doubles at the others.

@param cells of ushort, unsigned, or double where no unsigned holds the sums.
@param longestCell a bound of the difference of neighbouring edges.
@param maxValue the largest value that is summed. */
template <typename Sum>
void writeBits(const DescriptorPlan& plan, const ChannelGroup& group, const CellGrid<Sum>& cells,
        const CellEdges& edges, double longestCell, int maxValue, Workspace& workspace, uchar* descriptor)
{
    const LevelWriter writer = {plan, group, edges, 4. * maxValue, workspace, descriptor};
    writer.writeFitting(plan.finest, cells, longestCell);
}

}  // namespace iib
}  // namespace cv
