// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#pragma once

#include "batch_job.hpp"

namespace cv { namespace iib {

template <typename Cell> void widen(const CellGrid<Cell>& cells, CellGrid<double>& wide)
{
    wide.create(cells.size());
    for (int r = 0; r < cells.size(); r++)
        for (int parity = 0; parity < 2; parity++)
            std::copy_n(cells.row(r, parity), cells.size() / 2 * GROUP_CHANNELS, wide.row(r, parity));
}

//! The largest factor of Weights along one axis.
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

/** Writes the bits of a group of channels of one keypoint, level by level, from the sums over its finest cells. Products of
 sums and weights are 32-bit integers at levels where these surely fit, else doubles. */
struct LevelWriter
{
    const BatchJob& job;
    const ChannelGroup& group;
    const CellEdges& edges;
    const double largest;     //!< four times the largest value of a pixel
    uchar* const descriptor;  //!< has the bits of the groups before

    //! Whether sums over cells of the level, times their weights, fit an int. @param longest no cell is longer.
    bool fitsInt(int level, double longest) const
    {
        const double sum = largest * longest * longest, area = longest * longest;
        return sum * area <= INT_MAX || sum * largestWeight(group.levels[level], edges) <= INT_MAX;
    }

    //! Writes a level and all coarser ones.
    template <typename Sum> void write(int level, const CellGrid<Sum>& cells, double longest) const
    {
        auto& parents = job.workspace.sumsOf(typename BitsKernels<Sum>::Parent(), level - 1);
        job.plan.kernels.bits(Sum()).write[job.plan.parameters.mapping](
                cells, group.levels[level], edges, parents, descriptor);
        if (level > 1)
            writeFitting(level - 1, parents, 2 * longest);
    }

    //! The same, in doubles if integers are too small.
    template <typename Sum> void writeFitting(int level, const CellGrid<Sum>& cells, double longest) const
    {
        if (fitsInt(level, longest))
            return write(level, cells, longest);
        CellGrid<double>& wide = job.workspace.sumsOf(double(), level);
        widen(cells, wide);
        write(level, wide, longest);
    }
    void writeFitting(int level, const CellGrid<double>& cells, double longest) const
    {
        write(level, cells, longest);
    }
};

}}  // namespace cv::iib
