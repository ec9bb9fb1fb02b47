// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#include "double_bits.hpp"

#include "kernels/mappings.hpp"

namespace cv {
namespace iib {

namespace {

//! Maps one channel of one quad; put(bit, value) takes the bits.
template <typename Mapping, typename Put>
void mapQuad(const CellGrid<double>& cells, const Axis& xAxis, const Axis& yAxis, int row, int col,
        int channel, const Put& put)
{
    const Weights x(xAxis, col), y(yAxis, row);
    const double weighted[4] = {cells.cell(row, col)[channel] * ((double)x.first * y.first),
            cells.cell(row, col + 1)[channel] * ((double)x.second * y.first),
            cells.cell(row + 1, col)[channel] * ((double)x.first * y.second),
            cells.cell(row + 1, col + 1)[channel] * ((double)x.second * y.second)};
    Mapping::map(weighted, put);
}

struct LevelBits
{
    const CellGrid<double>& cells;
    const LevelShape& shape;
    const Axis x, y;
    BitWriter& out;

    template <typename Mapping> void visit() const
    {
        for (int i = 0; i < QuadPhase::COUNT; i++)
            if (shape.uses(i))
                phaseBits<Mapping>(i);
    }

private:
    template <typename Mapping> void phaseBits(int index) const
    {
        const QuadPhase phase(shape.n, index);
        const int planeBits = 8 * phase.planeBytes();
        AutoBuffer<uchar> planes(phase.rows * Mapping::BITS * phase.planeBytes() + 8);
        std::fill_n(planes.data(), planes.size(), (uchar)0);
        for (int r = 0; r < phase.rows; r++)
            for (int lane = 0; lane < phase.lanes(); lane++)
                mapQuad<Mapping>(cells, x, y, phase.dy + 2 * r, phase.dx + lane / GROUP_CHANNELS * 2,
                        lane % GROUP_CHANNELS, [&](int plane, bool bit) {
                            const int at = (r * Mapping::BITS + plane) * planeBits + lane;
                            planes[at / 8] |= (uchar)(bit << at % 8);
                        });
        if (!shape.chosen.empty())
            return shape.chosen[index].append(planes.data(), out);
        for (int plane = 0; plane < phase.rows * Mapping::BITS; plane++)
            for (int lane = 0; lane < phase.lanes(); lane++)
                if (lane % GROUP_CHANNELS < shape.channels)
                    out.append(planes[(plane * planeBits + lane) / 8] >> lane % 8 & 1, 1);
    }
};

}  // namespace

void doubleLevelBits(int mapping, const CellGrid<double>& cells, const LevelShape& shape,
        const CellEdges& edges, uchar* descriptor)
{
    BitWriter out(descriptor, shape.offset);
    const LevelBits visitor = {cells, shape, {edges.x, shape.step}, {edges.y, shape.step}, out};
    visitMapping(mapping, visitor);
}

}  // namespace iib
}  // namespace cv
