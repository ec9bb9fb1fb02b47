// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#include "bits.hpp"
#include "mappings.hpp"

namespace cv {
namespace iib {

namespace {

enum { MAX_BITS = (1 << (MAX_GRANULARITY - 1)) * GROUP_CHANNELS };

//! Maps one channel of one quad; put(bit, value) takes the bits.
template <typename Mapping, typename Put>
void mapQuad(const CellGrid<double>& cells, const LevelShape& shape, int row, int col, int channel, const Put& put)
{
    const Weights x(shape.x, col), y(shape.y, row);
    const double weighted[4] = { cells.cell(row, col)[channel] * ((double)x.first * y.first),
                                 cells.cell(row, col + 1)[channel] * ((double)x.second * y.first),
                                 cells.cell(row + 1, col)[channel] * ((double)x.first * y.second),
                                 cells.cell(row + 1, col + 1)[channel] * ((double)x.second * y.second) };
    Mapping::map(weighted, put);
}

//! Quads whose top left cells are in rows dy, dy + 2, ... and columns dx, dx + 2, ...
template <typename Mapping>
void windowBits(const CellGrid<double>& cells, const LevelShape& shape, int dy, int dx, BitWriter& out)
{
    bool planes[Mapping::BITS][MAX_BITS];
    for (int row = dy; row + 1 < shape.n; row += 2)
    {
        int count = 0;
        for (int col = dx; col + 1 < shape.n; col += 2)
            for (int channel = 0; channel < shape.channels; channel++, count++)
                mapQuad<Mapping>(cells, shape, row, col, channel, [&](int plane, bool bit)
                {
                    planes[plane][count] = bit;
                });
        for (int plane = 0; plane < Mapping::BITS; plane++)
            for (int i = 0; i < count; i++)
                out.append(planes[plane][i], 1);
    }
}

struct LevelBits
{
    const CellGrid<double>& cells;
    const LevelShape& shape;
    BitWriter& out;

    template <typename Mapping> void visit() const
    {
        for (int dy = 0; dy <= (int)shape.overlap; dy++)
            for (int dx = 0; dx <= (int)shape.overlap; dx++)
                windowBits<Mapping>(cells, shape, dy, dx, out);
    }
};

struct SelectedBits
{
    const CellGrid<double>& cells;
    const LevelShape& shape;
    const std::vector<QuadPlace>& quads;
    const int words;
    uint64* const planes;

    template <typename Mapping> void visit() const
    {
        std::fill(planes, planes + words * Mapping::BITS, (uint64)0);
        for (size_t lane = 0; lane < quads.size() * GROUP_CHANNELS; lane++)
        {
            const QuadPlace& quad = quads[lane / GROUP_CHANNELS];
            mapQuad<Mapping>(cells, shape, quad.row, quad.col, lane % GROUP_CHANNELS, [&](int plane, bool bit)
            {
                planes[plane * words + lane / 64] |= (uint64)bit << lane % 64;
            });
        }
    }
};

}  // namespace

void wideLevelBits(int mapping, const CellGrid<double>& cells, const LevelShape& shape, BitWriter& out)
{
    const LevelBits visitor = { cells, shape, out };
    visitMapping(mapping, visitor);
}

void wideSelectedBits(int mapping, const CellGrid<double>& cells, const LevelShape& shape,
                      const std::vector<QuadPlace>& quads, int words, uint64* planes)
{
    const SelectedBits visitor = { cells, shape, quads, words, planes };
    visitMapping(mapping, visitor);
}

}  // namespace iib
}  // namespace cv
