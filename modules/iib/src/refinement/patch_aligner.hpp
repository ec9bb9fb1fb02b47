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
    Vec2d centre;
    Matx22d map;
};

struct PatchAlignment
{
    bool accepted;
    Vec2d point;        //!< in the second image, pixels
    double similarity;  //!< correlation of the two patches
    Matx22d covariance;
};

//! Smooths a normalized image; the result is a part of a larger one, where its border is repeated.
Mat preparedForAlignment(const Mat& normalized);

//! Least-squares matching of patches, one after the other: what a thread needs for that.
class PatchAligner
{
public:
    PatchAligner();

    /** Finds where the surroundings of a point of the first image are in the second one. Both images are prepared by
     preparedForAlignment().
     @param point inside the image, as the starts.
     @param unit of the patch, in pixels of the first image, up to 1.
     @param starts places of the point in the second image; the one that agrees best is taken.
     @param limit pixels that the point may move in the second image. */
    PatchAlignment align(const Mat& image1, const Vec2d& point, double unit, const Mat& image2,
            const std::vector<PatchPlace>& starts, double limit);

private:
    struct Moments
    {
        double sums[SUMS];       //!< of the samples less their mean, times weights, from SUM_TEMPLATE on
        double mean, deviation;  //!< of the samples
    };

    Vec2d readTemplate(const Mat& image, const Vec2d& point, double unit);
    void readWindow(const Mat& image, const PatchPlace& place, double margin);
    bool sampleAt(const PatchPlace& place);
    Moments momentsOf(const short* values) const;
    double similarityOf(const Moments& moments) const;
    bool solveTemplate();
    Vec6d step(const Moments& moments) const;
    Matx22d covariance(const Moments& moments, const Vec2d& beside) const;

    const RefinementKernels& kernels;
    const PatchWeights& weights;
    PatchTemplate patch;
    Moments ofTemplate;
    double totals[SUMS];        //!< of the weights
    double independentSamples;  //!< as many as the weighted ones are worth
    Matx66d inverse;            //!< of the normal matrix
    Rect pixels;                //!< of the image that the window holds
    AlignedBuffer<int> window;
    AlignedBuffer<short> samples, ones;
};

}  // namespace iib
}  // namespace cv
