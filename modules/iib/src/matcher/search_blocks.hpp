// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#ifndef OPENCV_IIB_MATCHER_SEARCH_BLOCKS_HPP
#define OPENCV_IIB_MATCHER_SEARCH_BLOCKS_HPP

namespace cv {
namespace iib {

/** How many queries and CodeBlocks of train codes a scan takes at once. The train codes of 170 bytes fill 352 KB, so that
they stay in a second-level cache of 512 KB while the queries, 704 KB, pass by. */
struct SearchBlocks
{
    SearchBlocks() : queries(4096), codeBlocks(128) {}
    int queries, codeBlocks;
};

//! What the matcher offers to tests, so that small data crosses the boundaries of blocks. ADAPTIVE's results depend on
//! codeBlocks; nothing else does.
class BlockedMatcher
{
public:
    virtual ~BlockedMatcher() {}
    virtual void setSearchBlocks(const SearchBlocks& blocks) = 0;
};

}  // namespace iib
}  // namespace cv

#endif
