// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#ifndef OPENCV_IIB_DETAIL_CODE_LAYOUT_HPP
#define OPENCV_IIB_DETAIL_CODE_LAYOUT_HPP

#include "opencv2/core.hpp"

namespace cv { namespace iib {

//! @cond IGNORED

//! Of rows, among all images of a search.
static constexpr int INDEX_BITS = 40;

//! How codes are kept so that a kernel compares one query with many of them at once. The numbers stand in files: what a
//! number means, and what CodeLayout makes of it, never changes.
enum CodePacking
{
    /** Words combined so that half as many population counts do. With c the plain words, word 0 is c[0], then
    follow c[0] ^ ... ^ c[2k] ^ c[2k + 1] and c[2k + 1] ^ c[2k + 2]. The differences of two such codes are just
    what a chain of full adders needs for parity and carry, and
        Hamming distance = popcount(parity) + 2 * sum of popcount(carry). */
    PACKING_ADDERS = 1,
    //! Plain bytes, whose distances are looked up in tables of the query's.
    PACKING_TABLES = 2
};

/** Where the bits of a descriptor lie in a code of 32-bit words, and how CODES_PER_BLOCK codes lie side by side in a
CodeBlock.

A code has a segment for each level, filled up with zeros to whole words. Only the last level has two segments:
every fourth of its words, a sample that tells much more than its beginning would, and the rest.

A CodeBlock has words() * CODES_PER_BLOCK words: word w of code i is at w * CODES_PER_BLOCK + i with PACKING_ADDERS, and
byte b of code i at byte b * CODES_PER_BLOCK + i with PACKING_TABLES. */
class CodeLayout
{
public:
    static constexpr int CODES_PER_BLOCK = 16;

    //! Sizes of the levels in bytes, coarse first.
    CodeLayout(const std::vector<int>& levelSizes, CodePacking packing);

    const std::vector<int>& levelSizes() const { return sizes; }
    int levels() const { return (int)sizes.size(); }
    //! Bytes of a descriptor.
    int bytes() const { return width; }

    int segments() const { return (int)ends.size(); }
    //! Words up to the end of a segment; PACKING_ADDERS makes it odd.
    int end(int segment) const { return ends[segment]; }
    //! Bits of descriptors in the first words.
    int bits(int count) const { return bitsBefore[count]; }
    //! Words of a code.
    int words() const { return ends.back(); }
    //! Words of a CodeBlock.
    size_t blockWords() const { return (size_t)words() * CODES_PER_BLOCK; }

    //! From a descriptor to the plain words of its code, and back.
    void arrange(const uchar* descriptor, unsigned* plain) const;
    void restore(const unsigned* plain, uchar* descriptor) const;

    //! Packs the words of one code; only with PACKING_ADDERS.
    void pack(const unsigned* plain, unsigned* packed) const;
    //! Puts a descriptor into a lane of a CodeBlock. Neither this nor storeBlock() can fail.
    void store(const uchar* descriptor, unsigned* block, int lane) const;
    //! Fills a whole CodeBlock with CODES_PER_BLOCK descriptors that lie `step` bytes apart.
    void storeBlock(const uchar* descriptors, size_t step, unsigned* block) const;
    //! Gets the plain words of a code.
    void fetch(const unsigned* block, int lane, unsigned* plain) const;

private:
    //! A word's bytes in the descriptor, 1 to 4 of them; none for filling.
    struct Place
    {
        int from, bytes;
    };

    //! Word i of a descriptor's code, plain.
    unsigned word(int i, const uchar* descriptor) const;

    std::vector<int> sizes, ends;
    std::vector<Place> places;    // of each word
    std::vector<int> bitsBefore;  // each word, and in all
    int width;
    CodePacking packing;
};

//! @endcond

}}  // namespace cv::iib

#endif
