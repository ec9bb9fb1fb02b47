// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#include "bits.hpp"
#include "mappings.hpp"

namespace cv {
namespace iib {

namespace {

enum { MAX_BITS = (1 << (MAX_GRANULARITY - 1)) * GROUP_CHANNELS };

//! A row's bits, a plane for each bit of the mapping.
struct Put
{
    std::array<std::array<bool, MAX_BITS>, 8>& planes;
    int index;

    void operator()(int plane, bool bit) const { planes[plane][index] = bit; }
};

template <typename Mapping>
void windowBits(const CellGrid<double>& cells, const LevelShape& shape, int dy, int dx, BitWriter& out)
{
    std::array<std::array<bool, MAX_BITS>, 8> planes;
    for (int r = dy; r + 1 < shape.n; r += 2)
    {
        int count = 0;
        for (int c = dx; c + 1 < shape.n; c += 2)
            for (int channel = 0; channel < shape.channels; channel++)
            {
                const double left = shape.widths[c + 1], right = shape.widths[c];
                const double top = shape.heights[r + 1], bottom = shape.heights[r];
                const double x[4] = { cells.cell(r, c)[channel] * (left * top),
                                      cells.cell(r, c + 1)[channel] * (right * top),
                                      cells.cell(r + 1, c)[channel] * (left * bottom),
                                      cells.cell(r + 1, c + 1)[channel] * (right * bottom) };
                const Put put = { planes, count++ };
                Mapping::map(x, put);
            }
        for (int plane = 0; plane < Mapping::BITS; plane++)
            for (int i = 0; i < count; i++)
                out.append(planes[plane][i], 1);
    }
}

template <typename Mapping> void levelBits(const CellGrid<double>& cells, const LevelShape& shape, BitWriter& out)
{
    for (int dy = 0; dy <= (int)shape.overlap; dy++)
        for (int dx = 0; dx <= (int)shape.overlap; dx++)
            windowBits<Mapping>(cells, shape, dy, dx, out);
}

}  // namespace

void wideLevelBits(int mapping, const CellGrid<double>& cells, const LevelShape& shape, BitWriter& out)
{
    switch (mapping)
    {
    case IIB::MAPPING_MEAN: return levelBits<MeanMapping>(cells, shape, out);
    case IIB::MAPPING_MAX: return levelBits<MaxMapping>(cells, shape, out);
    case IIB::MAPPING_MIN: return levelBits<MinMapping>(cells, shape, out);
    case IIB::MAPPING_QUARTILE: return levelBits<QuartileMapping>(cells, shape, out);
    case IIB::MAPPING_SORT: return levelBits<SortMapping>(cells, shape, out);
    case IIB::MAPPING_HAAR: return levelBits<HaarMapping>(cells, shape, out);
    default: return levelBits<PairwiseMapping>(cells, shape, out);
    }
}

}  // namespace iib
}  // namespace cv
