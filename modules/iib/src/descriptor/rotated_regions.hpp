// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#pragma once

#include "regions.hpp"

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

//! A rotated region is cut to this side, so that the offsets of its points fit 32 bits.
static constexpr double LARGEST_ROTATED_SIDE = 16384;

//! An upright square that holds the region at any angle, and two pixels for roundings.
SupportRegion circumscribed(const SupportRegion& region);

//! The pixels of the image that a region may sample at any angle, at least one. @param border one of IIB::Border.
Rect rotatedPixels(const SupportRegion& region, int border, Size image);

//! Whether no corner of a region rotated by `angle`, and so no sample, lies outside the image.
bool isInsideRotated(const SupportRegion& region, float angle, Size image);

}  // namespace iib
}  // namespace cv
