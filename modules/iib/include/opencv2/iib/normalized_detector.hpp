// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#ifndef OPENCV_IIB_NORMALIZED_DETECTOR_HPP
#define OPENCV_IIB_NORMALIZED_DETECTOR_HPP

#include "opencv2/iib/features.hpp"

namespace cv { namespace iib {

//! @addtogroup iib
//! @{

/** @brief Finds the keypoints of another detector on the locally normalized image, where light changes them less.

Detectors look for contrast, and light decides where there is contrast: by night other points are the strongest than by
day. Local normalization takes away the local mean and the local contrast before the detector sees the image:
`(I - G*I) / (sqrt(G*(I - G*I)^2) + 2)`, where I is the grey image of 0..255 and G* a Gaussian filter of `sigma` pixels
(made of halvings and short blurs, so that its cost does not depend on sigma), scaled by 40 around 128 and rounded to 8
bits.

Descriptors are best computed on the plain image: IIBDescriptorExtractor::createFor takes this detector and does so, and
IIBDescriptorExtractor::scaleFactorFor gives the factor of the detector inside. compute and detectAndCompute of this
class describe with the detector inside, on the plain image too; one of another library gets images of 16U and 32F as
8-bit grey, from the image's own minimum to its maximum. A mask is CV_8UC1 of the image's size, or empty.

Images may be 8U, 16U or 32F with 1, 3 (BGR) or 4 (BGRA) channels. The largest value of 16-bit images counts as 255;
float values are taken between the image's own minimum and maximum. The normalized image is the same for every
instruction set and thread count. An empty image gives no keypoints.

@throws cv::Exception from detect, compute and detectAndCompute for images and masks of another type or size and for
pixels that are NaN or infinite; from those that describe, if the detector inside does not describe keypoints.
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

    //! In pixels; as create() takes it, and throws a cv::Exception where it does.
    CV_WRAP virtual void setSigma(float sigma) = 0;
    CV_WRAP virtual float getSigma() const = 0;
};

//! @}

}}  // namespace cv::iib

#endif
