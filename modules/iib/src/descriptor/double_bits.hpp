// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#ifndef OPENCV_IIB_DESCRIPTOR_DOUBLE_BITS_HPP
#define OPENCV_IIB_DESCRIPTOR_DOUBLE_BITS_HPP

#include "kernels/quads.hpp"

namespace cv {
namespace iib {

//! The bits of a level where an int is too small for the products.
void doubleLevelBits(int mapping, const CellGrid<double>& cells, const LevelShape& shape,
        const CellEdges& edges, uchar* descriptor);

}  // namespace iib
}  // namespace cv

#endif
