// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#ifndef OPENCV_IIB_DESCRIPTOR_BIT_ENCODER_HPP
#define OPENCV_IIB_DESCRIPTOR_BIT_ENCODER_HPP

#include "kernels/bits.hpp"

namespace cv {
namespace iib {

/** From the sums over the finest cells of a keypoint to its bits, level by level. Holds the memory that one
 thread uses again for each keypoint. */
class BitEncoder
{
public:
    //! @param group which four of the channels; @param channels how many of them are in use.
    BitEncoder(const Parameters& parameters, int group, int channels);

    //! Cells in a row at the finest level that has bits.
    int size() const { return 1 << granularity; }

    //! Where the sums over the finest cells go, for Cell = ushort, unsigned or double: the first that holds them.
    template <typename Cell> CellGrid<Cell>& finestCells();

    //! Where the edges of the finest cells go, paddedEdges(size()) and size() + 1 of them, in pixels or samples.
    int* xEdges() { return x.data(); }
    int* yEdges() { return y.data(); }

    /** Writes the bits of all levels into a descriptor; the groups before have written theirs. The sums are in
     finestCells<Cell>(), the edges in xEdges() and yEdges().
     @param longestCell a bound of the difference of neighbouring edges.
     @param maxValue the largest value that was summed. */
    template <typename Cell> void write(double longestCell, int maxValue, uchar* descriptor)
    {
        writeFrom(granularity, finestCells<Cell>(), 4. * maxValue, longestCell, descriptor);
    }

private:
    /** Writes a level and, from the sums of its cells, all coarser ones: in one call of a kernel as many as surely fit
     its integers.
     @param value four times the largest that was summed. @param longest a bound of the lengths of this level's cells. */
    template <typename Cell>
    void writeFrom(int level, const CellGrid<Cell>& cells, double value, double longest, uchar* descriptor);
    void writeFrom(int level, const CellGrid<double>& cells, uchar* descriptor);
    template <typename Cell> const BitsKernels<Cell>& kernels() const;

    const int granularity, mapping;
    const BitsKernels<ushort> shortKernels;
    const BitsKernels<unsigned> longKernels;
    std::vector<int> x, y;  //!< edges
    std::vector<std::vector<ChosenBits>>
            chosen;                  //!< of the windows of each level; empty if all quads are in use
    std::vector<LevelShape> shapes;  //!< of each level
    CellGrid<ushort> shortSums;      //!< of the finest level
    std::vector<CellGrid<unsigned>> sums;
    std::vector<CellGrid<double>> wideSums;
};

template <> inline CellGrid<ushort>& BitEncoder::finestCells<ushort>() { return shortSums; }
template <> inline CellGrid<unsigned>& BitEncoder::finestCells<unsigned>() { return sums[granularity]; }
template <> inline CellGrid<double>& BitEncoder::finestCells<double>() { return wideSums[granularity]; }
template <> void BitEncoder::write<double>(double longestCell, int maxValue, uchar* descriptor);

}  // namespace iib
}  // namespace cv

#endif
