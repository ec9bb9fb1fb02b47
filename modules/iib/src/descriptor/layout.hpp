// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#ifndef OPENCV_IIB_DESCRIPTOR_LAYOUT_HPP
#define OPENCV_IIB_DESCRIPTOR_LAYOUT_HPP

#include "parameters.hpp"

namespace cv {
namespace iib {

//! Bits of a level before it is padded to whole bytes; the order of the bits is in descriptor.hpp.
int levelBits(const Parameters& parameters, int level);

//! Bytes of each level that has any, coarse first.
std::vector<int> levelBytes(const Parameters& parameters);

//! The finest level that has any bit.
int finestLevel(const Parameters& parameters);

//! The place of a group's first bit of a level in the descriptor.
int bitOffset(const Parameters& parameters, int level, int group);

}  // namespace iib
}  // namespace cv

#endif
