// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#ifndef OPENCV_IIB_SEARCHED_CODES_PRIVATE_HPP
#define OPENCV_IIB_SEARCHED_CODES_PRIVATE_HPP

#include "opencv2/core.hpp"

namespace cv {
namespace iib {

class PackedCodes;

/** Codes of images, packed as this library searches them: what a module that keeps codes in files builds on. Not installed,
since it may change with every version.

Codes lie in blocks of CODES_PER_BLOCK. Which bit lies where is the layout, a number that may stand in files: the layout of
a number never changes. Blocks are the same bytes on machines of either byte order. */
class CV_EXPORTS SearchedCodes
{
public:
    enum
    {
        CODES_PER_BLOCK = 16,
        ROW_BITS = 40  //!< all rows that are searched together are fewer than 2^ROW_BITS
    };

    //! @throws cv::Exception for level sizes that HierarchicalMatcher::create does not take, and for none.
    static void check(const std::vector<int>& levelSizes);
    //! Whether codes of that layout can be searched.
    static bool knows(unsigned layout);
    //! Whether blocks of that many rows are zero wherever no bit of a descriptor lies, as blocks() are. Others give wrong
    //! distances.
    static bool fillsWithZeros(
            const std::vector<int>& levelSizes, unsigned layout, size_t rows, const Mat& blocks);
    //! Bytes of a block.
    static size_t blockBytes(const std::vector<int>& levelSizes, unsigned layout);

    //! Packs CV_8U descriptors, a matrix for each image or a single one, in the layout that suits the instruction set.
    SearchedCodes(const std::vector<int>& levelSizes, InputArrayOfArrays descriptors);
    /** Codes that lie elsewhere, and stay there if their layout suits the instruction set; if not, they are copied.
    @param layout a known one
    @param starts first row of each image, and the number of all rows
    @param blocks as blocks() gives them, aligned to 64 bytes */
    SearchedCodes(const std::vector<int>& levelSizes, unsigned layout, const std::vector<size_t>& starts,
            const Mat& blocks);

    unsigned layout() const;
    //! All blocks, CV_32S, a row each, continuous.
    Mat blocks() const;

    size_t images() const;
    size_t rows() const;
    //! Rows of an image, and the first of them.
    size_t rows(size_t image) const;
    size_t start(size_t image) const;
    //! The image of a row.
    size_t imageOf(size_t row) const;
    //! The descriptors of an image as they were added.
    Mat descriptors(size_t image) const;

    //! Some codes of a search.
    struct Part
    {
        const SearchedCodes* codes;
        size_t firstRow;           //!< what results call the first of its rows
        std::vector<bool> hidden;  //!< of each image, whether it is left out; empty: none is
    };
    /** The k nearest rows of each query, nearest first, ties in the order of rows.
    @param parts codes of the same level sizes, firstRow ascending
    @param rows queries x k, -1 where there are fewer
    @param distances as many
    @throws cv::Exception for queries that do not fit, and for k < 1 */
    static void findNearest(const std::vector<int>& levelSizes, const std::vector<Part>& parts,
            InputArray queries, int k, std::vector<int64>& rows, std::vector<int>& distances);

private:
    Ptr<PackedCodes> packed;
};

}  // namespace iib
}  // namespace cv

#endif
