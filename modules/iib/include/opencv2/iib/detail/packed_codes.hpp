// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#ifndef OPENCV_IIB_DETAIL_PACKED_CODES_HPP
#define OPENCV_IIB_DETAIL_PACKED_CODES_HPP

#include "opencv2/iib/detail/code_layout.hpp"

namespace cv { namespace iib {

//! @cond IGNORED

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
