// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#pragma once

#include "../common/aligned_buffer.hpp"
#include "kernels/kernels.hpp"

namespace cv {
namespace iib {

//! A patch on an image: its centre, and the linear map from the patch's units to pixels.
struct PatchPlace
{
    double x, y;
    Matx22d map;
};

struct PatchAlignment
{
    bool accepted;
    double x, y;           //!< of the patch's centre in the second image, pixels
    double similarity;     //!< correlation of the two patches
    double covariance[3];  //!< xx, xy, yy of x and y
};

//! Least-squares matching of patches, one after the other: what a thread needs for that.
class PatchAligner
{
public:
    PatchAligner();

    /** Finds where the patch of the first image is in the second one. Both images are normalized and smoothed, CV_8U.
     @param limit pixels that it may move in the second image. */
    PatchAlignment align(
            const Mat& image1, const PatchPlace& place1, const Mat& image2, PatchPlace place2, double limit);

private:
    struct Moments
    {
        double sums[SUMS];  //!< of the samples less their mean, times weights
        double deviation;
    };

    void readWindow(const Mat& image, const PatchPlace& place, double margin);
    bool sampleAt(const PatchPlace& place);
    Moments momentsOf(bool all) const;
    bool makeTemplate();

    const RefinementKernels& kernels;
    const PatchWeights& weights;
    Rect pixels;  //!< of the image that the window holds
    AlignedBuffer<int> window;
    AlignedBuffer<short> samples, derivativesX, derivativesY, weightsOfSums;
    const short* weightsOf[SUMS];
    short* templateWeights[SUMS - SUM_TEMPLATE];
    double totals[SUMS];  //!< of the weights
    double factors[6];    //!< that weights of derivatives hold
    Moments ofTemplate;
    Matx66d inverse;  //!< of the normal matrix
};

//! Smooths a normalized image for it.
Mat smoothedForAlignment(const Mat& normalized);

}  // namespace iib
}  // namespace cv
