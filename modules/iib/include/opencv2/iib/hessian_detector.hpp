// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#ifndef OPENCV_IIB_HESSIAN_DETECTOR_HPP
#define OPENCV_IIB_HESSIAN_DETECTOR_HPP

#include "opencv2/iib/features.hpp"

namespace cv { namespace iib {

//! @addtogroup iib
//! @{

/** @brief Finds blobs: maxima over place and scale of the determinant of the Hessian @cite Lindeberg1998
@cite Bay2008SURF of the locally normalized image.

Made for IIBDescriptorExtractor, where light and camera change; IIBDescriptorExtractor::createRecommended puts the two
together. The image is normalized locally as NormalizedDetector does it (sigma of the Gaussian: `normalizationSigma`),
and smoothed by Gaussians of `sigma`, `sigma` * sqrt(2), `sigma` * 2, ..., one for each scale. The response is
`sigma^4 (Ixx Iyy - Ixy^2)` in units of the local standard deviation. A keypoint is a pixel whose response is positive, at least
`threshold`, and the largest among its neighbours in place (3 x 3) and in the scales before and after; of neighbours
with the same response, one stays. Scales of less than 4 pixels are searched at the image's resolution, larger scales at
half of it, which is enough for them. Keypoints move exactly with a picture that moves by a multiple of 16 pixels, the steps of
the local normalization; by other whole numbers of pixels most of the strong ones do, to a tenth, and fewer of the weak ones.

Of a keypoint
- `pt` is refined to fractions of a pixel by a quadratic fit of the response;
- `size` is twice the sigma in pixels of the image, refined between scales in the same way
  (IIBDescriptorExtractor::scaleFactorFor: 18);
- `angle` is -1 (none), `octave` the number of the scale, `response` the response.

Images whose longer side has more than `workingSize` pixels are reduced first, by the smallest whole factor that is
enough, but long and narrow ones by no more than leaves a quarter of `workingSize` to the shorter side (means of the
factor's square of pixels): on photographs of many megapixels the smallest scales find noise and grass, and
take most of the time. Keypoints are in the image's own pixels all the same.

Keypoints come strongest first, those of the same response by scale, row and column. None lie nearer to
the border than 2 sigma. They are the same on every instruction set and for every number of threads.

Images may be 8U, 16U or 32F with 1, 3 (BGR) or 4 (BGRA) channels, ROIs and UMats too. Only differences relative to the
local contrast count; the largest value of 16-bit images stands for white, and float values are taken between the
image's own minimum and maximum. An empty image gives no keypoints. Masks are CV_8UC1 of the image's size; keypoints
whose rounded position is 0 there are left out before the strongest are chosen.

The detector keeps no state between calls: one object may serve many threads.

@throws cv::Exception from detect for images and masks of another type or size and for pixels that are NaN or infinite;
from compute and detectAndCompute with descriptors: this class does not describe.
 */
class CV_EXPORTS_W HessianDetector : public Feature2D
{
public:
    /** @brief Creates a detector.

    @param maxFeatures the strongest that are kept; 0 keeps all.
    @param threshold smallest response, 0 or more. 0 keeps every maximum; .01 leaves out the faintest.
    @param scales number of scales, 1 to 8, each sqrt(2) times the one before.
    @param sigma of the smallest scale in pixels of the (reduced) image, 1.5 to 8. Smaller blobs are found less reliably
    when light or view change.
    @param normalizationSigma of the local normalization's Gaussian in pixels of the (reduced) image, 2 to 256.
    @param workingSize of images, pixels of the longer side, 64 or more; larger ones are reduced. 0 never reduces.
    @throws cv::Exception (StsOutOfRange) for other values.
     */
    CV_WRAP static Ptr<HessianDetector> create(int maxFeatures = 1000, float threshold = 0.f, int scales = 5,
            float sigma = 2.2f, float normalizationSigma = 5.f, int workingSize = 1024);

    //! Setters take what create() takes, and throw a cv::Exception where it does; the old value then stays.
    CV_WRAP virtual void setMaxFeatures(int maxFeatures) = 0;
    CV_WRAP virtual int getMaxFeatures() const = 0;
    CV_WRAP virtual void setThreshold(float threshold) = 0;
    CV_WRAP virtual float getThreshold() const = 0;
    CV_WRAP virtual void setScales(int scales) = 0;
    CV_WRAP virtual int getScales() const = 0;
    CV_WRAP virtual void setSigma(float sigma) = 0;
    CV_WRAP virtual float getSigma() const = 0;
    CV_WRAP virtual void setNormalizationSigma(float normalizationSigma) = 0;
    CV_WRAP virtual float getNormalizationSigma() const = 0;
    CV_WRAP virtual void setWorkingSize(int workingSize) = 0;
    CV_WRAP virtual int getWorkingSize() const = 0;
};

//! @}

}}  // namespace cv::iib

#endif
