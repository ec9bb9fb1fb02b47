// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#include "compute.hpp"

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

//! Whether the largest weighted sum of a level surely fits an int, where no value exceeds `largest` and no cell is longer
//! than `longest`.
bool fitsInt(const LevelShape& shape, const CellEdges& edges, double largest, double longest)
{
    const double area = longest * longest;
    return largest * area * area <= INT_MAX || largest * area * largestWeight(shape, edges) <= INT_MAX;
}

}  // namespace

//! The bits of the levels from `finest` on.
static void writeDoubles(const DescriptorPlan& plan, const ChannelGroup& group, int finest,
        const CellGrid<double>& cells, const CellEdges& edges, Workspace& workspace, uchar* descriptor)
{
    plan.kernels.doubleBits[plan.parameters.mapping].write(
            cells, group.levels.data(), edges, finest, 1, workspace.doubleSums, descriptor);
}

template <>
void writeBits(const DescriptorPlan& plan, const ChannelGroup& group, const CellGrid<double>& cells,
        const CellEdges& edges, double, int, Workspace& workspace, uchar* descriptor)
{
    writeDoubles(plan, group, plan.finest, cells, edges, workspace, descriptor);
}

template <typename Sum>
void writeBits(const DescriptorPlan& plan, const ChannelGroup& group, const CellGrid<Sum>& cells,
        const CellEdges& edges, double longestCell, int maxValue, Workspace& workspace, uchar* descriptor)
{
    const LevelShape* const shapes = group.levels.data();
    const int finest = plan.finest;
    int level = finest;  // the finest that needs doubles; 0 if none does
    for (double l = longestCell; level > 0 && fitsInt(shapes[level], edges, 4. * maxValue, l); l *= 2)
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
    writeDoubles(plan, group, level, wide, edges, workspace, descriptor);
}

template void writeBits(const DescriptorPlan&, const ChannelGroup&, const CellGrid<ushort>&, const CellEdges&,
        double, int, Workspace&, uchar*);
template void writeBits(const DescriptorPlan&, const ChannelGroup&, const CellGrid<unsigned>&,
        const CellEdges&, double, int, Workspace&, uchar*);

}  // namespace iib
}  // namespace cv
