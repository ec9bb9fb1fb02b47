// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#ifndef OPENCV_IIB_DESCRIPTOR_ROTATION_HPP
#define OPENCV_IIB_DESCRIPTOR_ROTATION_HPP

namespace cv {
namespace iib {

/** A keypoint's angle. The functions of the C library differ in the last place from machine to machine, and with it
 samples and bits: here, only doubles are added and multiplied, in one order, after an exact reduction. */
struct Rotation
{
    double cosine, sine;  //!< error below 1e-15
    int steps;            //!< the angle in ORIENTATION_STEPS a turn

    //! @param degrees clockwise in the image; any finite number.
    explicit Rotation(float degrees);
};

}  // namespace iib
}  // namespace cv

#endif
