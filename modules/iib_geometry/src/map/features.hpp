// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "map.hpp"
#include "opencv2/iib.hpp"

namespace cv::iib {

//! The extractor of a map's features: createRecommended, or the paper's detectors and descriptor.
Ptr<IIB> extractorOf(bool orbAndAkaze, int points);

/** Detects and describes keypoints, in pixels of the full image. Name, camera, pose and points stay unset.
@param maxSize longer side, pixels, to which larger images are reduced; 0: images are not reduced.
@param angle of all keypoints: degrees by which the image is rotated clockwise; -1: upright. */
void extract(
        IIB& iib, const Mat& image, const Mat& mask, MapImage& features, int maxSize = 0, float angle = -1);

//! @throws cv::Exception unless the image is 8-bit grey or BGR and of the camera's size, and its mask fits.
inline void checkPhotograph(const Mat& image, const Mat& mask, const Size& size)
{
    if (!mask.empty() && (mask.type() != CV_8UC1 || mask.size() != image.size()))
        CV_Error(Error::StsBadArg, "a mask must be CV_8UC1 and of its image's size");
    if (image.type() != CV_8UC1 && image.type() != CV_8UC3)
        CV_Error(Error::StsBadArg, "an image must be 8-bit, grey or BGR, not " + typeToString(image.type()));
    if (image.size() != size)
        CV_Error(Error::StsBadArg, format("the image has %d x %d pixels and its camera %d x %d", image.cols,
                                           image.rows, size.width, size.height));
}

}  // namespace cv::iib
