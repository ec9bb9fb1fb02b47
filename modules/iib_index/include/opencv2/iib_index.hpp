// SPDX-License-Identifier: Apache-2.0

#ifndef OPENCV_IIB_INDEX_HPP
#define OPENCV_IIB_INDEX_HPP

#include "opencv2/core.hpp"

/**
@defgroup iib_index Binary codes in files, searched where they lie
*/

namespace cv {
namespace iib {

//! @addtogroup iib_index
//! @{

/** @brief Binary codes in a folder, searched where they lie: for more codes than memory should hold, for several programs
that search the same codes, and for programs that should be ready at once.

A folder has a manifest and segments. A segment is a file that never changes: the codes of the images that one call of
add() added, packed as the search reads them, with a checksum for about every mebibyte. Segments are mapped into memory
when they are first searched, and checked once, then. **From there on a segment must not be changed:** if it is shortened,
the system ends the program that reads it (SIGBUS), and if it is overwritten, answers are wrong. To delete it, or to rename
another file over it, does not disturb who has it mapped. No call of this class does any of that.

Rows are numbered through all images ever added, from 0, and so are images; removed ones keep their numbers.

**Commits.** add() and remove() write what is new and then rename a new manifest into place. Whatever fails, a full disk or
a killed process, the folder stays as it was after the last call that returned: a call that throws has committed nothing.
Writers of one folder wait for each other, in one process or several; what each of them commits stays. Readers see the state
that they opened until refresh(). The folder is the index's own; the next writer removes the unfinished files of a killed
one (`segment-000001.iib.*.tmp`, `manifest.iib.*.tmp`), and no others.

**Machines.** Files are the same bytes on all. The packing that suits this machine's instruction set is used and named in
the segment; a machine that searches another packing converts it when it is first searched, into memory.

**Threads.** Any number of threads may search one object as long as none calls add(), remove() or refresh() of it.
Searches run on cv::parallel_for_; results are the same for every number of threads, every instruction set, and however
the rows are spread over segments.

@throws cv::Exception from every call that reads a manifest, and from the first that reads a segment, if the file is missing,
truncated, altered or of a newer version; it names the file. StsOutOfRange for a row, an image or a segment that is not there.
 */
class CV_EXPORTS MappedIndex
{
public:
    /** @brief Makes a folder, or takes an empty one, and commits an index without images.

    @param folder the parent has to exist.
    @param levelSizes as in HierarchicalMatcher::create; a single level is enough.
    @throws cv::Exception if the folder holds anything, or cannot be written.
     */
    static Ptr<MappedIndex> create(const String& folder, const std::vector<int>& levelSizes);

    //! Opens the last commit. Reads the manifest alone.
    static Ptr<MappedIndex> open(const String& folder);

    virtual ~MappedIndex();

    //! Bytes of each level, coarse first.
    virtual std::vector<int> levelSizes() const = 0;
    //! Images ever added, removed ones too.
    virtual int64 images() const = 0;
    //! Rows of all images ever added.
    virtual int64 rows() const = 0;
    //! Files that hold them, one for each call of add() that had images.
    virtual int segments() const = 0;
    //! Changes with every commit: the manifest's checksum.
    virtual uint64 version() const = 0;

    //! The image of a row. Maps its segment.
    virtual int64 imageOf(int64 row) const = 0;
    //! The first row of an image. Maps its segment.
    virtual int64 firstRow(int64 image) const = 0;
    //! The descriptors of an image as they were added. Maps its segment.
    virtual Mat descriptors(int64 image) const = 0;

    /** @brief Adds images behind those of the last commit, whoever made it, as one segment, and commits them.

    @param descriptors a matrix for each image, CV_8U, a row a descriptor; or a single matrix. They are packed in memory
    first. A search is at its best with segments of 10^5 rows and more: add many images at once.
    @throws cv::Exception for descriptors of another type or width, and if the folder cannot be written.
     */
    virtual void add(InputArrayOfArrays descriptors) = 0;

    //! Hides images of the last commit, whoever made it, from all searches, and commits that. Their codes stay on the disk.
    virtual void remove(const std::vector<int64>& images) = 0;

    //! Goes on to the last commit. Segments that were mapped stay so.
    virtual void refresh() = 0;

    /** @brief The k nearest rows of each query by Hamming distance, as brute force finds them; ties in the order of rows.

    @param queryDescriptors CV_8U, a row a query.
    @param k > 0.
    @param rows queries x k, nearest first; -1 where there are fewer.
    @param distances as many, in bits; -1 where there are fewer.
    @param segment search this one alone; -1 for all.
    @throws cv::Exception for queries of another type or width, and (StsOutOfRange) for k < 1.
     */
    virtual void knnSearch(InputArray queryDescriptors, int k, std::vector<int64>& rows,
            std::vector<int>& distances, int segment = -1) const = 0;
};

//! @}

}  // namespace iib
}  // namespace cv

#endif
