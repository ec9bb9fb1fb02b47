// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#include "bit_encoder.hpp"

namespace cv {
namespace iib {

namespace {

template <typename Cell> void widen(const CellGrid<Cell>& cells, CellGrid<double>& wide)
{
    wide.create(cells.size());
    for (int r = 0; r < cells.size(); r++)
        for (int parity = 0; parity < 2; parity++)
            std::copy_n(cells.row(r, parity), cells.size() / 2 * GROUP_CHANNELS, wide.row(r, parity));
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

double largestWeight(const LevelShape& shape, const CellEdges& edges)
{
    const Axis x = {edges.x, shape.step}, y = {edges.y, shape.step};
    return largestWeight(x, shape.n) * largestWeight(y, shape.n);
}

//! Whether four times the largest weighted sum of a level surely fits an int, where no cell is longer than `longest`.
bool fitsInt(const LevelShape& shape, const CellEdges& edges, double largest, double longest)
{
    const double area = longest * longest;
    return largest * area * area <= INT_MAX || largest * area * largestWeight(shape, edges) <= INT_MAX;
}

}  // namespace

BitEncoder::BitEncoder(
        const DescriptorPlan& plan_, const ChannelGroup& group_, int maxValue, Workspace& workspace_)
    : plan(plan_), group(group_), largest(4. * maxValue), workspace(workspace_)
{
    for (int level = 0; level < plan.finest; level++)
    {
        workspace.sums[level].create(1 << level);
        workspace.doubleSums[level].create(1 << level);
    }
}

template <typename Sum>
void BitEncoder::write(
        const CellGrid<Sum>& cells, const CellEdges& edges, double longestCell, uchar* descriptor) const
{
    const LevelShape* const shapes = group.levels.data();
    const int finest = plan.finest;
    int level = finest;  // the finest that needs doubles; 0 if none does
    for (double l = longestCell; level > 0 && fitsInt(shapes[level], edges, largest, l); l *= 2)
        level--;
    CellGrid<double>& wide = workspace.doubleSums[level];
    if (level == finest)
        widen(cells, wide);
    else
        plan.kernels.sums(Sum()).bits[plan.parameters.mapping].write(
                cells, shapes, edges, finest, level + 1, workspace.sums, descriptor);
    if (level == 0)
        return;
    if (level < finest)
        widen(workspace.sums[level], wide);
    writeDoubles(level, wide, edges, descriptor);
}

void BitEncoder::writeDoubles(
        int finest, const CellGrid<double>& cells, const CellEdges& edges, uchar* descriptor) const
{
    plan.kernels.doubleBits[plan.parameters.mapping].write(
            cells, group.levels.data(), edges, finest, 1, workspace.doubleSums, descriptor);
}

template void BitEncoder::write(const CellGrid<ushort>&, const CellEdges&, double, uchar*) const;
template void BitEncoder::write(const CellGrid<unsigned>&, const CellEdges&, double, uchar*) const;

}  // namespace iib
}  // namespace cv
