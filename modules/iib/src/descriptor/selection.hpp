// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#ifndef OPENCV_IIB_DESCRIPTOR_SELECTION_HPP
#define OPENCV_IIB_DESCRIPTOR_SELECTION_HPP

#include "layout.hpp"

namespace cv {
namespace iib {

/** A phase on a level: the quads whose top left cells are in rows dy, dy + 2, ... and columns dx, dx + 2, ... Their
 comparisons lie in memory row by row, and in a row plane by plane, of which there is one for each bit of the mapping; a
 plane has GROUP_CHANNELS bits for each quad, and is made of whole chunks. */
struct QuadPhase
{
    int dy, dx, rows, quads;

    enum
    {
        COUNT = 4,
        CHUNK = 16
    };

    //! @param i 0 to COUNT - 1, which of those on n x n cells; but for the first they are there with overlap only.
    QuadPhase(int n, int i) : dy(i / 2), dx(i % 2), rows((n - dy) / 2), quads((n - dx) / 2) {}

    int lanes() const { return quads * GROUP_CHANNELS; }
    int planeBytes() const { return (lanes() + CHUNK - 1) / CHUNK * (CHUNK / 8); }
};

//! The chosen bits of a phase (paper, "Reduction of the IIB Descriptor Size").
class ChosenBits
{
public:
    //! @param group which four of the channels.
    ChosenBits(const Parameters& parameters, int level, int group, int phase);

    bool none() const { return words.empty(); }

    //! Moves the bits of a mask together, to the low end.
    struct Compressor
    {
        uint64 mask, moves[6];
        int count;

        explicit Compressor(uint64 mask);
        uint64 operator()(uint64 bits) const;
    };

    //! Eight bytes of the comparisons of which any bit is chosen.
    struct Word
    {
        size_t byte;
        Compressor compressor;
    };

    const std::vector<Word>& chosenWords() const { return words; }

    //! Appends them, in their order.
    void append(const uchar* comparisons, BitWriter& out) const
    {
        for (const Word& word : words)
            out.append(word.compressor(loadWord(comparisons + word.byte)), word.compressor.count);
    }

private:
    std::vector<Word> words;
};

}  // namespace iib
}  // namespace cv

#endif
