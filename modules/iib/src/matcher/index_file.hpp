// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#ifndef OPENCV_IIB_MATCHER_INDEX_FILE_HPP
#define OPENCV_IIB_MATCHER_INDEX_FILE_HPP

#include "opencv2/iib/checked_file.private.hpp"
#include "parameters.hpp"

namespace cv {
namespace iib {

/* Format 1 of an index, a checked file: u32: number of levels, each level's bytes, mode, cross-check; f32: maximal ratio,
each threshold; u64: number of images, each image's rows; the descriptors of all images. Descriptors pass through in
pieces, so that no second copy of them is in memory. */

//! What stands before the descriptors.
struct IndexHeader
{
    MatcherParameters parameters;
    std::vector<uint64> rows;  //!< of each image
};

class IndexWriter
{
public:
    IndexWriter(const String& filename, const IndexHeader& header);
    //! Writes the next descriptors, continuous CV_8U; what image they belong to follows from the header.
    void write(const Mat& descriptors) { file.bytes(descriptors.data, descriptors.total()); }
    //! Puts the file in its place.
    void finish();

private:
    CheckedWriter file;
};

//! Checks that the file is whole and that its numbers make sense together; whether they are valid parameters is for the
//! matcher to say.
class IndexReader
{
public:
    explicit IndexReader(const String& filename);
    const IndexHeader& header() const { return head; }
    //! Fills a continuous matrix with the next descriptors.
    void read(Mat& descriptors) { file.bytes(descriptors.data, descriptors.total()); }
    //! Throws unless all was read and the checksum fits.
    void finish();

private:
    CheckedReader file;
    IndexHeader head;
};

}  // namespace iib
}  // namespace cv

#endif
