// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#ifndef OPENCV_IIB_MATCHER_KERNELS_CODE_LAYOUT_HPP
#define OPENCV_IIB_MATCHER_KERNELS_CODE_LAYOUT_HPP

#include "opencv2/core.hpp"

namespace cv {
namespace iib {

//! How codes are kept so that a kernel compares one query with many of them at once.
enum CodePacking
{
    /** Words combined so that half as many population counts do. With c the plain words, word 0 is c[0], then
    follow c[0] ^ ... ^ c[2k] ^ c[2k + 1] and c[2k + 1] ^ c[2k + 2]. The differences of two such codes are just
    what a chain of full adders needs for parity and carry, and
        Hamming distance = popcount(parity) + 2 * sum of popcount(carry). */
    PACKING_ADDERS,
    //! Plain bytes, whose distances are looked up in tables of the query's.
    PACKING_TABLES
};

/** Where the bits of a descriptor lie in a code of words of 32 bits, and codes side by side in a group of CODES_PER_BLOCK.

A code has a part for each level, filled up with zeros to whole words. Only the last level has two: every
fourth of its words, a sample that tells much more than its beginning would, and the rest. */
class CV_EXPORTS CodeLayout
{
public:
    enum
    {
        CODES_PER_BLOCK = 16
    };

    //! Sizes of the levels in bytes, coarse first.
    CodeLayout(const std::vector<int>& levelSizes, CodePacking packing);

    const std::vector<int>& levelSizes() const { return sizes; }
    int levels() const { return (int)sizes.size(); }
    //! Bytes of a descriptor.
    int bytes() const { return width; }

    int parts() const { return (int)ends.size(); }
    //! Words up to the end of a part; PACKING_ADDERS makes it odd.
    int end(int part) const { return ends[part]; }
    //! Bits of descriptors in a part.
    int bits(int part) const { return partBits[part]; }
    //! Words of a code.
    int words() const { return ends.back(); }

    //! From a descriptor to the plain words of its code, and back.
    void arrange(const uchar* descriptor, unsigned* plain) const;
    void restore(const unsigned* plain, uchar* descriptor) const;

    //! From plain words to packed ones, in place.
    void pack(unsigned* code) const;
    //! Packs plain words, in place, and puts them into a lane of a group of CODES_PER_BLOCK * words() words.
    void store(unsigned* plain, unsigned* group, int lane) const;
    //! Gets its plain words.
    void fetch(const unsigned* group, int lane, unsigned* plain) const;

private:
    //! A word's bytes in the descriptor, 1 to 4 of them; none for filling.
    struct Place
    {
        int from, bytes;
    };

    std::vector<int> sizes, ends, partBits;
    std::vector<Place> places;  // of each word
    int width;
    CodePacking packing;
};

}  // namespace iib
}  // namespace cv

#endif
