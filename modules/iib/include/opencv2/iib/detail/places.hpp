// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#ifndef OPENCV_IIB_DETAIL_PLACES_HPP
#define OPENCV_IIB_DETAIL_PLACES_HPP

#include "opencv2/iib/descriptor.hpp"

namespace cv { namespace iib {

//! @cond IGNORED

// Places of quads and boxes, for this library and for programs that learn selections.

constexpr int GROUP_CHANNELS = 4;  //!< channels that integral images and kernels process together

//! n x n boxes, in 80ths of the region's side.
struct BoxGrid
{
    int n;
    int side;   //!< of a box
    int reach;  //!< distance of the outermost centres from the region's

    //! The centre of box i of a row or column, in sides of the region from its centre.
    double centre(int i) const { return reach * (2. * i / (n - 1) - 1) / 80; }

    //! Its left or upper edge (direction -1), or the opposite one (1); equal for boxes that meet.
    double edge(int i, int direction) const
    {
        return (2 * reach * i - (n - 1) * reach + direction * side * (n - 1) / 2.) / (80. * (n - 1));
    }
};

static constexpr int BOX_LEVELS = 5;

//! Level g is BOX_GRIDS[g - 1].
static const BoxGrid BOX_GRIDS[BOX_LEVELS] = {{3, 32, 24}, {5, 24, 28}, {7, 16, 30}, {9, 8, 32}, {7, 6, 12}};

inline int bitsPerQuad(int mapping)
{
    static const int bits[] = {4, 4, 4, 8, 8, 3, 4};  // in the order of IIB::Mapping
    return bits[mapping];
}

//! Rows (and columns) of places at a level: quads, also between siblings, or boxes.
inline int placesInRow(int mapping, int level)
{
    return mapping == IIB::MAPPING_BOXES ? BOX_GRIDS[level - 1].n : (1 << level) - 1;
}

//! @endcond

}}  // namespace cv::iib

#endif
