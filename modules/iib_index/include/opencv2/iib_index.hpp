// SPDX-License-Identifier: Apache-2.0

#ifndef OPENCV_IIB_INDEX_HPP
#define OPENCV_IIB_INDEX_HPP

#include "opencv2/core.hpp"

/**
@defgroup iib_index Binary codes in files, searched in place
*/

namespace cv { namespace iib {

//! @addtogroup iib_index
//! @{

/** @brief Binary codes in a folder, searched in place: for more codes than memory should hold, for several programs
that share codes, and for a fast start.

A folder has a manifest and segments. A segment is a file that never changes. It holds the codes of the images of one
call of add(), packed for the search, with a checksum for about every mebibyte. It is mapped into memory and checked
when it is first searched. **A mapped segment must not be changed:** if it is shortened, the system ends the program
(SIGBUS); if it is overwritten, results are wrong. Deleting it, or renaming another file over it, is harmless. No call
of this class changes a segment.

Rows and images are numbered from 0 in the order in which they were added; removed images keep their numbers.

**Commits.** add() and remove() write new files, then rename a new manifest into place. After any failure, such as a
full disk or a killed process, the folder is as after the last successful call. A call that throws has committed
nothing. Writers of one folder wait for each other, in one process or several. Readers see the state that they opened
until refresh(). The folder must hold nothing else; a writer removes the unfinished files of killed writers
(`segment-000001.iib.*.tmp`, `manifest.iib.*.tmp`).

**Machines.** Files are portable. A segment names its packing, which suits the instruction set of the machine that wrote
it. A machine with another packing converts the segment in memory on first use.

**Threads.** Threads may search one object concurrently, unless one calls add(), remove() or refresh() of it.
Searches run on cv::parallel_for_. Results do not depend on the number of threads, the instruction set or the segments.

@throws cv::Exception that names the file, from each call that reads a manifest and from the first that reads a segment,
if the file is missing, truncated, altered or of a newer version. (StsOutOfRange) for a missing row, image or segment.
 */
class CV_EXPORTS MappedIndex
{
public:
    /** @brief Commits an index without images to a new or empty folder.

    @param folder its parent must exist.
    @param levelSizes as in HierarchicalMatcher::create; a single level is enough.
    @throws cv::Exception if the folder is not empty or cannot be written.
     */
    static Ptr<MappedIndex> create(const String& folder, const std::vector<int>& levelSizes);

    //! Opens the last commit. Reads only the manifest.
    static Ptr<MappedIndex> open(const String& folder);

    virtual ~MappedIndex();

    //! Bytes of each level, coarse first.
    virtual std::vector<int> levelSizes() const = 0;
    //! Number of images ever added, including removed ones.
    virtual int64 images() const = 0;
    //! Number of rows of these images.
    virtual int64 rows() const = 0;
    //! Number of segment files, one for each call of add() with images.
    virtual int segments() const = 0;
    //! The manifest's checksum, which changes with every commit.
    virtual uint64 version() const = 0;

    //! The image of a row. Maps its segment.
    virtual int64 imageOf(int64 row) const = 0;
    //! The first row of an image. Maps its segment.
    virtual int64 firstRow(int64 image) const = 0;
    //! The descriptors of an image. Maps its segment.
    virtual Mat descriptors(int64 image) const = 0;

    /** @brief Commits images as one segment after those of the last commit, even one of another process.

    @param descriptors one CV_8U matrix per image, a descriptor a row; or a single matrix. They are packed in memory
    first. Add many images at once: searches are fastest with segments of 10^5 rows or more.
    @throws cv::Exception for descriptors of another type or width, and if the folder cannot be written.
     */
    virtual void add(InputArrayOfArrays descriptors) = 0;

    //! Commits that images of the last commit, even one of another process, are hidden from searches. Their codes stay
    //! on disk.
    virtual void remove(const std::vector<int64>& images) = 0;

    //! Switches to the last commit. Mapped segments stay mapped.
    virtual void refresh() = 0;

    /** @brief Finds the k nearest rows of each query by Hamming distance, as brute force does; ties in the order of
    rows.

    @param queryDescriptors CV_8U, one query a row.
    @param k > 0.
    @param rows queries x k, nearest first; -1 if there are fewer than k rows.
    @param distances of these rows, in bits; -1 if there are fewer.
    @param segment the only segment to search; -1 searches all.
    @throws cv::Exception for queries of another type or width, and (StsOutOfRange) for k < 1.
     */
    virtual void knnSearch(InputArray queryDescriptors, int k, std::vector<int64>& rows,
            std::vector<int>& distances, int segment = -1) const = 0;
};

//! @}

}}  // namespace cv::iib

#endif
