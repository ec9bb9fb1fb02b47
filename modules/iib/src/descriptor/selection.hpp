// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#ifndef OPENCV_IIB_DESCRIPTOR_SELECTION_HPP
#define OPENCV_IIB_DESCRIPTOR_SELECTION_HPP

#include "kernels/quads.hpp"
#include "parameters.hpp"

namespace cv {
namespace iib {

//! The bits that the parameters' selection chooses in a phase of a level. @param group which four of the channels.
ChosenBits chosenBits(const Parameters& parameters, int level, int group, int phase);

}  // namespace iib
}  // namespace cv

#endif
