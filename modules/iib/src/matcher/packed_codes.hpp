// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#ifndef OPENCV_IIB_MATCHER_PACKED_CODES_HPP
#define OPENCV_IIB_MATCHER_PACKED_CODES_HPP

#include "kernels/hamming.hpp"

namespace cv {
namespace iib {

//! Train codes of several images, one after the other, packed for the kernels that were the best when it was made.
class PackedCodes
{
public:
    explicit PackedCodes(const std::vector<int>& levelSizes);
    PackedCodes(const PackedCodes& other);
    PackedCodes& operator=(const PackedCodes&) = delete;

    const CodeLayout& layout() const { return format; }
    //! The kernels that the codes are packed for; others would misread them.
    const HammingKernels& kernels() const { return scans; }

    size_t rows() const { return starts.back(); }
    size_t images() const { return starts.size() - 1; }
    size_t rows(size_t image) const { return starts[image + 1] - starts[image]; }
    //! From a row of all to its image; subtract start(image) for the row in it.
    size_t imageOf(size_t row) const;
    size_t start(size_t image) const { return starts[image]; }

    int blocks() const { return filled; }
    //! A CodeBlock; those after it follow without a gap. Lanes beyond rows() are zeros.
    const unsigned* block(int i) const { return codes.ptr<unsigned>(i); }

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
    void store(const Mat& descriptors);

    const HammingKernels& scans;
    const CodeLayout format;
    std::vector<size_t> starts;  //!< first row of each image, and the number of all rows
    Mat codes;                   //!< a row a CodeBlock, which makes them aligned
    int filled;                  //!< of these rows
};

}  // namespace iib
}  // namespace cv

#endif
