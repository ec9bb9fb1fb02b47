// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "manifest.hpp"

namespace cv {
namespace iib {

//! A commit of an index, ready to be searched.
class IndexCommit
{
public:
    //! Takes segments over from an earlier commit, which may have them mapped.
    //! @throws cv::Exception if the manifest's level sizes make no sense.
    IndexCommit(const String& folder, const Manifest& manifest, const IndexCommit* before);

    const Manifest& manifest() const { return committed; }
    int segments() const { return (int)opened.size(); }
    int64 images() const { return (int64)firstImages.back(); }
    int64 rows() const { return (int64)firstRows.back(); }

    int64 imageOf(int64 row) const;
    int64 firstRow(int64 image) const;
    Mat descriptors(int64 image) const;
    //! A segment's part of a search.
    SearchedCodes::Part part(int segment) const;

private:
    Manifest committed;
    std::vector<Ptr<CodeSegment>> opened;
    std::vector<size_t> firstRows, firstImages;  //!< of each segment, and the number of all
};

//! @throws cv::Exception (StsOutOfRange) unless 0 <= number < count.
void checkNumber(int64 number, uint64 count, const char* what);

}  // namespace iib
}  // namespace cv
