// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#ifndef OPENCV_IIB_DESCRIPTOR_GRADIENT_ORIENTATION_HPP
#define OPENCV_IIB_DESCRIPTOR_GRADIENT_ORIENTATION_HPP

#include "kernels/kernels.hpp"

namespace cv {
namespace iib {

enum
{
    ORIENTATION_CELLS = 32,  //!< in a row of the grid over a region whose gradients vote for its angle
    ORIENTATION_SUB = 2      //!< a cell has ORIENTATION_SUB x ORIENTATION_SUB points
};

/** The direction that prevails among gradients (Sobel 3x3) between cells: a peak of their smoothed histogram, in which
 each counts by its magnitude and by a Gaussian of half the region's radius around the centre.

@param pixels, index of the points of ORIENTATION_CELLS x ORIENTATION_CELLS cells, as for mapSums; the fourth value of a
pixel is its intensity.
@param rank 0 for the highest peak, 1 for the next, and so on; the lowest if there are not so many.
@return degrees, 0 <= angle < 360, clockwise in the image; 0 if there is no peak. */
template <typename T>
float prevailingAngle(const DescriptorKernels& kernels, const T* pixels, const int* index, int rank);

}  // namespace iib
}  // namespace cv

#endif
