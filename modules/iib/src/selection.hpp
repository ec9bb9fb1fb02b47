// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#ifndef OPENCV_IIB_SELECTION_HPP
#define OPENCV_IIB_SELECTION_HPP

#include "layout.hpp"

namespace cv {
namespace iib {

//! The quad whose top left cell is (row, col).
struct QuadPlace
{
    int row, col;
};

/** The chosen quads of one level and group of channels (paper, "Reduction of the IIB Descriptor Size"). All
 channels of a place are compared, a lane each, sixteen places to a word; then the chosen bits are kept. */
class SelectedQuads
{
public:
    SelectedQuads() {}
    SelectedQuads(const Parameters& parameters, int level, int group);

    const std::vector<QuadPlace>& places() const { return quads; }

    //! Words of a plane, of which there is one for each bit of the mapping.
    int words() const { return (int)(quads.size() + WORD_QUADS - 1) / WORD_QUADS; }

    //! Appends the chosen bits of planes of `words()` words each.
    void append(const uint64* planes, BitWriter& out) const;

    enum { WORD_QUADS = 64 / GROUP_CHANNELS };

private:
    //! Moves the bits of a mask together, to the low end.
    struct Compressor
    {
        uint64 mask, moves[6];
        int count;

        explicit Compressor(uint64 mask = 0);
        uint64 operator()(uint64 bits) const;
    };

    std::vector<QuadPlace> quads;
    std::vector<Compressor> compressors;  //!< of each word of each plane
};

}  // namespace iib
}  // namespace cv

#endif
