// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#pragma once

#include "../precomp.hpp"

namespace cv { namespace iib {

//! See HessianDetector::create.
struct HessianParameters
{
    int maxFeatures;
    float threshold;
    int scales;
    float sigma, normalizationSigma;
    int workingSize;

    //! Throws StsOutOfRange for values that HessianDetector::create refuses.
    void check() const;
};

/** The keypoints of HessianDetector.

@param normalized CV_8U, the normalized image.
@param mask of the image: empty or CV_8U.
@param reduction side of the square of image pixels behind a pixel of `normalized`. */
std::vector<KeyPoint> findBlobs(
        const Mat& normalized, const HessianParameters& parameters, const Mat& mask, int reduction);

}}  // namespace cv::iib
