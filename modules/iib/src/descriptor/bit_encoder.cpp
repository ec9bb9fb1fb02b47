// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#include "bit_encoder.hpp"

#include "double_bits.hpp"

namespace cv {
namespace iib {

namespace {

template <typename Cell> void widen(const CellGrid<Cell>& cells, CellGrid<double>& wide)
{
    wide.create(cells.size());
    for (int r = 0; r < cells.size(); r++)
        for (int c = 0; c < cells.size(); c++)
            for (int i = 0; i < GROUP_CHANNELS; i++)
                wide.cell(r, c)[i] = cells.cell(r, c)[i];
}

void doubleParentSums(const CellGrid<double>& children, CellGrid<double>& cells)
{
    cells.create(children.size() / 2);
    for (int r = 0; r < cells.size(); r++)
        for (int c = 0; c < cells.size(); c++)
            for (int i = 0; i < GROUP_CHANNELS; i++)
                cells.cell(r, c)[i] =
                        (children.cell(2 * r, 2 * c)[i] + children.cell(2 * r, 2 * c + 1)[i]) +
                        (children.cell(2 * r + 1, 2 * c)[i] + children.cell(2 * r + 1, 2 * c + 1)[i]);
}

//! The largest factor by which Weights multiplies a sum, along one axis.
double largestWeight(const Axis& axis, int n)
{
    int smallest = INT_MAX, largest = 0;
    for (int i = 0; i < n; i++)
    {
        smallest = std::min(smallest, axis.length(i));
        largest = std::max(largest, axis.length(i));
    }
    return smallest == largest ? 1 : largest;
}

//! The largest sum of the channels in use.
template <typename Cell> Cell largestSum(const CellGrid<Cell>& cells, int channels)
{
    Cell largest = 0;
    for (int r = 0; r < cells.size(); r++)
        for (int c = 0; c < cells.size(); c++)
            for (int i = 0; i < channels; i++)
                largest = std::max(largest, cells.cell(r, c)[i]);
    return largest;
}

double largestWeight(const LevelShape& shape, const CellEdges& edges)
{
    const Axis x = {edges.x, shape.step}, y = {edges.y, shape.step};
    return largestWeight(x, shape.n) * largestWeight(y, shape.n);
}

//! Whether four times the largest weighted sum of a level fits an int, whatever the sums are.
bool alwaysFitsInt(const LevelShape& shape, const CellEdges& edges, double value, double longest)
{
    const double area = longest * longest;
    return value * area * area <= INT_MAX || value * area * largestWeight(shape, edges) <= INT_MAX;
}

}  // namespace

BitEncoder::BitEncoder(
        const DescriptorPlan& plan_, const ChannelGroup& group_, int maxValue, Workspace& workspace_)
    : plan(plan_), group(group_), value(4. * maxValue), workspace(workspace_)
{
    for (int level = 0; level < plan.finest; level++)
        workspace.sums[level].create(1 << level);
}

template <typename Sum>
void BitEncoder::writeFrom(int level, const CellGrid<Sum>& cells, const CellEdges& edges, double longest,
        uchar* descriptor) const
{
    const LevelShape* const shapes = group.levels.data();
    int coarsest = level + 1;
    for (double l = longest; coarsest > 1 && alwaysFitsInt(shapes[coarsest - 1], edges, value, l); l *= 2)
        coarsest--;
    const BitsKernels<Sum>& kernels = plan.kernels.sums<Sum>().bits[plan.parameters.mapping];
    if (coarsest > level)
    {
        const double weight = largestWeight(shapes[level], edges);
        // Centred sums have signs, and differences up to twice as large. Before, they must fit an int with a bit to spare.
        if (value * longest * longest <= 2. * INT_MAX &&
                8. * kernels.centre(cells, shapes[level], edges, workspace.centred) * weight <= INT_MAX)
        {
            plan.kernels.sums<unsigned>().bits[plan.parameters.mapping].levelBits(
                    workspace.centred, shapes, edges, level, level, workspace.sums, descriptor);
            if (level == 1)
                return;
            kernels.parentSums(cells, workspace.sums[level - 1]);
            return writeFrom(level - 1, workspace.sums[level - 1], edges, 2 * longest, descriptor);
        }
        if (4. * largestSum(cells, group.count) * weight > INT_MAX)
        {
            widen(cells, workspace.doubleSums[level]);
            return writeFrom(level, workspace.doubleSums[level], edges, longest, descriptor);
        }
    }
    coarsest = std::min(coarsest, level);
    kernels.levelBits(cells, shapes, edges, level, coarsest, workspace.sums, descriptor);
    if (coarsest > 1)
        writeFrom(coarsest - 1, workspace.sums[coarsest - 1], edges, longest * (2 << (level - coarsest)),
                descriptor);
}

template <>
void BitEncoder::writeFrom(int level, const CellGrid<double>& cells, const CellEdges& edges, double longest,
        uchar* descriptor) const
{
    doubleLevelBits(plan.parameters.mapping, cells, group.levels[level], edges, descriptor);
    if (level == 1)
        return;
    doubleParentSums(cells, workspace.doubleSums[level - 1]);
    writeFrom(level - 1, workspace.doubleSums[level - 1], edges, longest, descriptor);
}

template void BitEncoder::writeFrom(int, const CellGrid<ushort>&, const CellEdges&, double, uchar*) const;
template void BitEncoder::writeFrom(int, const CellGrid<unsigned>&, const CellEdges&, double, uchar*) const;

}  // namespace iib
}  // namespace cv
