// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#pragma once

#include "kernels/hamming.hpp"

namespace cv {
namespace iib {

//! Train codes of several images, one after the other. Those that are added are packed for the kernels that were the best
//! when it was made.
class PackedCodes
{
public:
    explicit PackedCodes(const std::vector<int>& levelSizes);
    /** Codes that lie elsewhere, and stay there if they are packed as the kernels want them; if not, they are copied. They
    are only read.
    @param starts first row of each image, and the number of all rows
    @param blocks a row a CodeBlock, CV_32S, aligned for vectors */
    PackedCodes(const std::vector<int>& levelSizes, CodePacking packing, const std::vector<size_t>& starts,
            const Mat& blocks);
    PackedCodes(const PackedCodes& other);
    PackedCodes& operator=(const PackedCodes&) = delete;

    const CodeLayout& layout() const { return format; }
    //! The kernels that layout() is for; others would misread it.
    const HammingKernels& kernels() const { return scans; }

    size_t rows() const { return starts.back(); }
    size_t images() const { return starts.size() - 1; }
    size_t rows(size_t image) const { return starts[image + 1] - starts[image]; }
    //! From a row of all to its image; subtract start(image) for the row in it.
    size_t imageOf(size_t row) const;
    size_t start(size_t image) const { return starts[image]; }

    int blocks() const { return filled; }
    //! The CodeBlocks of layout() from one on, without a gap. Lanes beyond rows() are zeros.
    const unsigned* block(int first) const { return codes.ptr<unsigned>(first); }
    //! All of them, a row each.
    Mat stored() const { return filled > 0 ? codes.rowRange(0, filled) : Mat(); }

    //! Adds an image's descriptors: CV_8U, layout().bytes() columns, any number of rows. Changes nothing if it throws.
    void add(const Mat& descriptors);
    //! Adds descriptors to the last image.
    void append(const Mat& descriptors);
    //! Makes memory for exactly these numbers of images and rows.
    void reserve(size_t images, size_t rows);

    //! Rows `from` to `to` of an image as they were added.
    Mat descriptors(size_t image, size_t from, size_t to) const;

private:
    //! Makes that many blocks filled ones; the new ones are zeros. Changes nothing if it throws.
    void grow(int blocks);
    //! Makes memory for that many blocks.
    void allocate(int blocks);

    const HammingKernels& scans;
    const CodeLayout format;
    std::vector<size_t> starts;  //!< first row of each image, and the number of all rows
    Mat codes;                   //!< a row a CodeBlock, which makes them aligned
    int filled;                  //!< of these rows
};

}  // namespace iib
}  // namespace cv
