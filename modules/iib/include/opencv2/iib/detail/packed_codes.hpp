// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#ifndef OPENCV_IIB_DETAIL_PACKED_CODES_HPP
#define OPENCV_IIB_DETAIL_PACKED_CODES_HPP

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

class PackedCodes;
struct HammingKernels;

//! One of several PackedCodes that are searched together.
struct CodePart
{
    const PackedCodes* codes;
    size_t firstRow;           //!< index of its first row in results
    std::vector<bool> hidden;  //!< for each image, whether it is left out; empty: no image is
};

/** Train codes of several images, packed for the best kernels at the time of construction. The module iib_index keeps them in
files. */
class CV_EXPORTS PackedCodes
{
public:
    //! @throws cv::Exception for level sizes that HierarchicalMatcher::create refuses.
    static void check(const std::vector<int>& levelSizes);
    //! Whether a number is a CodePacking.
    static bool knows(unsigned packing);
    //! Bytes of a CodeBlock.
    static size_t blockBytes(const std::vector<int>& levelSizes, unsigned packing);

    explicit PackedCodes(const std::vector<int>& levelSizes);
    //! @param descriptors CV_8U, a matrix for each image or one. @throws cv::Exception for a wrong width.
    PackedCodes(const std::vector<int>& levelSizes, InputArrayOfArrays descriptors);
    /** Refers to codes in the caller's memory, or converts a copy if the kernels need another packing.
    @param packing one of CodePacking
    @param starts first row of each image, and the number of all rows
    @param blocks a row a CodeBlock, CV_32S, aligned to 64 bytes */
    PackedCodes(const std::vector<int>& levelSizes, unsigned packing, const std::vector<size_t>& starts,
            const Mat& blocks);
    PackedCodes(const PackedCodes& other);
    PackedCodes& operator=(const PackedCodes&) = delete;

    const CodeLayout& layout() const { return format; }
    //! The kernels that layout() is for.
    const HammingKernels& kernels() const { return scans; }
    CodePacking packing() const;

    size_t rows() const { return starts.back(); }
    size_t images() const { return starts.size() - 1; }
    size_t rows(size_t image) const { return starts[image + 1] - starts[image]; }
    //! The image of a row; row - start(image) is its row in the image.
    size_t imageOf(size_t row) const;
    size_t start(size_t image) const { return starts[image]; }

    int blocks() const { return filled; }
    //! The CodeBlocks from `first` on, contiguous. Lanes beyond rows() are zeros.
    const unsigned* block(int first) const { return codes.ptr<unsigned>(first); }
    //! All CodeBlocks: CV_32S, a row each, continuous.
    Mat stored() const
    {
        return filled > 0 ? codes.rowRange(0, filled) : Mat(0, (int)format.blockWords(), CV_32S);
    }

    //! Adds an image's descriptors: CV_8U, layout().bytes() columns, any number of rows. Changes nothing if it throws.
    void add(const Mat& descriptors);
    //! Adds descriptors to the last image.
    void append(const Mat& descriptors);
    //! Makes memory for exactly these numbers of images and rows.
    void reserve(size_t images, size_t rows);

    //! Rows `from` to `to` of an image as they were added.
    Mat descriptors(size_t image, size_t from, size_t to) const;
    Mat descriptors(size_t image) const { return descriptors(image, 0, rows(image)); }

    /** The k nearest rows of each query, nearest first, ties in the order of rows.
    @param parts codes of the same level sizes, firstRow ascending
    @param rows queries x k, -1 where there are fewer
    @param distances as many
    @throws cv::Exception for queries that do not fit, and for k < 1 */
    static void findNearest(const std::vector<int>& levelSizes, const std::vector<CodePart>& parts,
            InputArray queries, int k, std::vector<int64>& rows, std::vector<int>& distances);

private:
    //! Appends blocks of zeros up to this number. Changes nothing if it throws.
    void grow(int blocks);
    void allocate(int blocks);

    const HammingKernels& scans;
    const CodeLayout format;
    std::vector<size_t> starts;  //!< first row of each image, and the number of all rows
    Mat codes;                   //!< a row a CodeBlock, aligned
    int filled;                  //!< rows in use
};

//! @endcond

}}  // namespace cv::iib

#endif
