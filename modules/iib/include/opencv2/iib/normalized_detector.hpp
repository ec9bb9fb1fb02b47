// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#ifndef OPENCV_IIB_NORMALIZED_DETECTOR_HPP
#define OPENCV_IIB_NORMALIZED_DETECTOR_HPP

#include "opencv2/iib/features.hpp"

namespace cv { namespace iib {

//! @addtogroup iib
//! @{

/** @brief Finds the keypoints of another detector on the locally normalized image, where they depend less on illumination.

Detectors look for contrast, which depends on illumination: the strongest points by night are not those by day. The
local mean and contrast are removed before detection: `(I - G*I) / (sqrt(G*(I - G*I)^2) + 2)`, where I is the grey image of
0..255 and G* a Gaussian filter of `sigma` pixels. The result is scaled by 40 around 128 and rounded to 8 bits. The time does
not depend on sigma.

Describe keypoints on the plain image, as an extractor of IIBDescriptorExtractor::createFor does. compute and
detectAndCompute of this class describe with the detector inside, on the plain image too. Detectors of other libraries
describe 16U and 32F as 8-bit grey, stretched from the image's minimum to its maximum. A mask is CV_8UC1 of the image's size,
or empty.

Images may be 8U, 16U or 32F with 1, 3 (BGR) or 4 (BGRA) channels. The largest value of 16-bit images counts as 255;
float values are scaled by the image's minimum and maximum. The normalized image is the same for every
instruction set and thread count. An empty image gives no keypoints.

@throws cv::Exception from detect, compute and detectAndCompute for images and masks of another type or size and for
pixels that are NaN or infinite; from compute, if the detector inside cannot describe keypoints.
 */
class CV_EXPORTS_W NormalizedDetector : public Feature2D
{
public:
    /** @brief Wraps a detector.

    @param detector finds the keypoints; any Feature2D but null.
    @param sigma of the Gaussian filter in pixels, 1 to 256.
    @throws cv::Exception (StsNullPtr, StsOutOfRange) for other values.
     */
    CV_WRAP static Ptr<NormalizedDetector> create(const Ptr<Feature2D>& detector, float sigma = 4.f);

    //! The detector inside.
    CV_WRAP virtual Ptr<Feature2D> getDetector() const = 0;

    //! In pixels, with the range of create().
    CV_WRAP virtual void setSigma(float sigma) = 0;
    CV_WRAP virtual float getSigma() const = 0;
};

//! @}

}}  // namespace cv::iib

#endif
