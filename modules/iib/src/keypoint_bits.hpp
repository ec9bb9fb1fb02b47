// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#ifndef OPENCV_IIB_KEYPOINT_BITS_HPP
#define OPENCV_IIB_KEYPOINT_BITS_HPP

#include "bits.hpp"

namespace cv {
namespace iib {

/** From the sums over the finest cells of a keypoint to its bits, level by level. Holds the memory that one
 thread uses again for each keypoint. */
class KeyPointBits
{
public:
    //! @param group which four of the channels; @param channels how many of them are in use.
    KeyPointBits(const Parameters& parameters, int group, int channels);

    //! Cells in a row at the finest level.
    int size() const { return 1 << granularity; }

    //! Where the sums over the finest cells go, if none exceeds UINT_MAX.
    CellGrid<int>& finestCells() { return sums[granularity]; }
    //! Where they go else.
    CellGrid<double>& finestWideCells() { return wideSums[granularity]; }

    /** Writes the bits of all levels into a descriptor; the groups before have written theirs.
     @param xEdges, yEdges size() + 1 edges of the finest cells in each direction, in pixels or samples.
     @param longestCell a bound of the difference of neighbouring edges.
     @param maxValue the largest value that was summed.
     @param wide whether the sums are in finestWideCells(). */
    void write(const int* xEdges, const int* yEdges, double longestCell, int maxValue, bool wide, uchar* descriptor);

private:
    bool fitsInt(int maxValue, double longest) const;
    void writeSelected(int level, const LevelShape& shape, bool wide, uchar* descriptor);

    //! The cells of the level at hand along one axis.
    struct Axis
    {
        int n, lengths[1 << MAX_GRANULARITY];

        void place(const int* edges, int cells);
        void coarsen();
        //! The largest length, times the largest factor that makes siblings comparable.
        double largestProduct() const;
    };

    const int granularity, mapping, channels;
    const bool overlap;
    const LevelBitsFunc levelBits;
    const SelectedBitsFunc selectedBits;
    const ParentSumsFunc parentSums;
    std::vector<int> offsets;  //!< of the group's first bit of each level
    std::vector<SelectedQuads> selection;  //!< of each level; empty if all quads are in use
    std::vector<uint64> planes;
    std::vector<CellGrid<int> > sums;
    std::vector<CellGrid<double> > wideSums;
    Axis x, y;
};

}  // namespace iib
}  // namespace cv

#endif
