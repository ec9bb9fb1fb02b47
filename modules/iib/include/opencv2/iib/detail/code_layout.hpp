// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#ifndef OPENCV_IIB_DETAIL_CODE_LAYOUT_HPP
#define OPENCV_IIB_DETAIL_CODE_LAYOUT_HPP

#include "opencv2/core.hpp"

namespace cv { namespace iib {

//! @cond IGNORED

//! Bits of a row's index among all images of a search.
static constexpr int INDEX_BITS = 40;

//! How codes are packed for the kernels. Files contain these numbers, so their meaning never changes.
enum CodePacking
{
    /** Combined words, which need half as many population counts. With plain words c, word 0 is c[0], followed by
    c[0] ^ ... ^ c[2k] ^ c[2k + 1] and c[2k + 1] ^ c[2k + 2]. Differences of two such codes are the inputs of a chain of
    full adders: Hamming distance = popcount(parity) + 2 * sum of popcount(carry). */
    PACKING_ADDERS = 1,
    //! Plain bytes, whose distances are looked up in tables made for the query.
    PACKING_TABLES = 2
};

/** The places of a descriptor's bits in a code of 32-bit words, and of CODES_PER_BLOCK codes in a CodeBlock.

A code has a segment for each level, padded with zeros to whole words. The last level has two segments: every fourth word,
which represents the level better than its first words do, and the rest.

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
    //! Words up to the end of a segment; with PACKING_ADDERS an odd number.
    int end(int segment) const { return ends[segment]; }
    //! Descriptor bits in the first `count` words.
    int bits(int count) const { return bitsBefore[count]; }
    int words() const { return ends.back(); }
    size_t blockWords() const { return (size_t)words() * CODES_PER_BLOCK; }

    //! arrange: descriptor to plain words. restore: the reverse.
    void arrange(const uchar* descriptor, unsigned* plain) const;
    void restore(const unsigned* plain, uchar* descriptor) const;

    //! Packs the words of one code; only with PACKING_ADDERS.
    void pack(const unsigned* plain, unsigned* packed) const;
    //! Packs a descriptor into a lane of a CodeBlock. Does not throw, nor does storeBlock().
    void store(const uchar* descriptor, unsigned* block, int lane) const;
    //! Packs CODES_PER_BLOCK descriptors, `step` bytes apart, into a CodeBlock.
    void storeBlock(const uchar* descriptors, size_t step, unsigned* block) const;
    //! Unpacks the plain words of a code.
    void fetch(const unsigned* block, int lane, unsigned* plain) const;

private:
    //! A word's bytes in the descriptor: 1 to 4 of them, 0 for padding.
    struct Place
    {
        int from, bytes;
    };

    //! Plain word i of a descriptor's code.
    unsigned word(int i, const uchar* descriptor) const;

    std::vector<int> sizes, ends;
    std::vector<Place> places;    //!< of each word
    std::vector<int> bitsBefore;  //!< each word, then the total
    int width;
    CodePacking packing;
};

//! @endcond

}}  // namespace cv::iib

#endif
