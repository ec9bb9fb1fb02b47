// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#ifndef OPENCV_IIB_DESCRIPTOR_ROTATED_REGION_HPP
#define OPENCV_IIB_DESCRIPTOR_ROTATED_REGION_HPP

#include "kernels/kernels.hpp"
#include "rotation.hpp"
#include "support_region.hpp"

namespace cv {
namespace iib {

/** The grid of points over a rotated region.
@param region, centre in pixels of the image; only the region's side counts, up to 16384.
@param n points in a row, up to MAX_SAMPLES_IN_ROW, `sub` x `sub` of them a cell. @param border one of IIB::Border. */
SampleGrid gridOf(const SupportRegion& region, Point2f centre, const Rotation& rotation, int n, int sub,
        int border, Size image);

//! The pixels of the image that a region may sample at any angle, at least one.
Rect rotatedPixels(const SupportRegion& region, Point2f centre, int border, Size image);

//! Whether no corner of a rotated region, and so no sample, lies outside the image.
bool rotatedIsInside(const SupportRegion& region, Point2f centre, float angle, Size image);

}  // namespace iib
}  // namespace cv

#endif
