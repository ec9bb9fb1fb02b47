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

Made for IIBDescriptorExtractor under changed illumination and view; IIBDescriptorExtractor::createRecommended combines
them. The image is normalized locally as in NormalizedDetector (sigma: `normalizationSigma`), and smoothed by a Gaussian
for each scale: `sigma`, `sigma` * sqrt(2), `sigma` * 2, ... The response is `sigma^4 (Ixx Iyy - Ixy^2)` in units of the local
standard deviation. A keypoint is a pixel whose response is positive, at least `threshold`, and the largest among its
neighbours in place (3 x 3) and in the scales before and after. Scales below 4 pixels are searched at the image's resolution,
larger ones at half of it. Keypoints move exactly with a picture that moves by a multiple of 16 pixels, the step of the local
normalization. For other shifts by whole pixels, most of the strong keypoints move to a tenth of a pixel.

Fields of a keypoint:
- `pt` is refined to fractions of a pixel by a quadratic fit of the response;
- `size` is twice the sigma in pixels of the image, refined between scales
  (IIBDescriptorExtractor::scaleFactorFor: 18);
- `angle` is -1 (none), `octave` the number of the scale, `response` the response.

Images whose longer side has more than `workingSize` pixels are reduced first, by means over squares of pixels, with the
smallest sufficient whole factor. The shorter side keeps at least a quarter of `workingSize`. In photographs of many
megapixels, the smallest scales find noise and take most of the time. Keypoints are in the image's own pixels.

Keypoints are sorted by response, strongest first, then by scale, row and column. None lies nearer to the border than
2 sigma. They are the same on every instruction set and for every number of threads.

Images may be 8U, 16U or 32F with 1, 3 (BGR) or 4 (BGRA) channels. The largest value of 16-bit images stands for white;
float values are scaled by the image's minimum and maximum. An empty image gives no keypoints. Masks are CV_8UC1 of the
image's size; keypoints whose rounded position is 0 there are removed before the strongest are chosen.

One object may serve many threads.

@throws cv::Exception from detect for images and masks of another type or size and for pixels that are NaN or infinite;
from compute and detectAndCompute with descriptors: this class does not describe.
 */
class CV_EXPORTS_W HessianDetector : public Feature2D
{
public:
    /** @brief Creates a detector.

    @param maxFeatures number of keypoints to keep, the strongest; 0 keeps all.
    @param threshold smallest response, 0 or more. 0 keeps every maximum; .01 drops the faintest.
    @param scales number of scales, 1 to 8, each sqrt(2) times the one before.
    @param sigma of the smallest scale in pixels of the (reduced) image, 1.5 to 8. Smaller blobs are less repeatable.
    @param normalizationSigma of the local normalization in pixels of the (reduced) image, 2 to 256.
    @param workingSize pixels of the longer side, 64 or more, above which images are reduced. 0 never reduces.
    @throws cv::Exception (StsOutOfRange) for other values.
     */
    CV_WRAP static Ptr<HessianDetector> create(int maxFeatures = 1000, float threshold = 0.f, int scales = 5,
            float sigma = 2.2f, float normalizationSigma = 5.f, int workingSize = 1024);

    //! Setters have the ranges of create(). If they throw, the old value stays.
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
