// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#pragma once

#include "../precomp.hpp"

namespace cv {
namespace iib {

//! The grids and bits of MAPPING_BOXES.

//! n x n boxes, in 80ths of the region's side.
struct BoxGrid
{
    int n;
    int side;   //!< of a box
    int reach;  //!< of the outermost centres from the region's

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

// Bits of a box in a channel, as in the mask of a selection: those of MAPPING_HAAR, and the comparisons of its own means.
static constexpr int BOX_HAAR_BITS = 3, BOX_HAAR_MASK = 7, BOX_FIRST_OWN_BIT = 8, BOX_SECOND_OWN_BIT = 16;

//! The bits that a box has. @param kind of the channel, one of IIB::Channel.
inline int boxMask(int kind, int level, int row, int col)
{
    const int last = BOX_GRIDS[level - 1].n - 1;
    const int haar = row < last && col < last ? BOX_HAAR_MASK : 0;
    switch (kind)
    {
    case IIB::CHANNEL_SIGNED_GRAD_X:
    case IIB::CHANNEL_SIGNED_GRAD_Y: return haar | BOX_FIRST_OWN_BIT | BOX_SECOND_OWN_BIT;
    case IIB::CHANNEL_GRAD_X: return haar | BOX_FIRST_OWN_BIT;
    default: return haar;
    }
}

}  // namespace iib
}  // namespace cv
