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
     @param starts places in the second image; the one that agrees best is taken.
     @param limit pixels that it may move in the second image. */
    PatchAlignment align(const Mat& image1, const PatchPlace& place1, const Mat& image2,
            const std::vector<PatchPlace>& starts, double limit);

private:
    struct Moments
    {
        double sums[SUMS];  //!< of the samples less their mean, times weights
        double deviation;
    };

    //! The first steps look at every second row alone.
    struct Level
    {
        int rowStep;
        double totals[SUMS];  //!< of the weights
        double squaresOfRoots;
        Moments ofTemplate;
    };

    void readWindow(const Mat& image, const PatchPlace& place, double margin);
    bool sampleAt(const PatchPlace& place, const Level& level);
    Moments momentsOf(const short* values, const Level& level) const;
    double similarityOf(const Moments& moments, const Level& level) const;
    bool makeTemplate();
    bool move(PatchPlace& place, const Moments& moments, const Level& level, double& distance) const;

    const RefinementKernels& kernels;
    const PatchWeights& weights;
    Rect pixels;  //!< of the image that the window holds
    AlignedBuffer<int> window;
    AlignedBuffer<short> samples, derivativesX, derivativesY, weightsOfSums;
    const short* weightsOf[SUMS];
    short* templateWeights[SUMS - SUM_TEMPLATE];
    Level coarse, fine;
    double factors[6];  //!< that weights of derivatives hold
    Matx66d inverse;    //!< of the normal matrix
};

//! Smooths a normalized image for it.
Mat smoothedForAlignment(const Mat& normalized);

}  // namespace iib
}  // namespace cv
