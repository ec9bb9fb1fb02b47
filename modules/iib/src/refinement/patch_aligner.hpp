// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#pragma once

#include "../common/aligned_buffer.hpp"
#include "kernels/kernels.hpp"

namespace cv { namespace iib {

//! A patch on an image: its centre, and the linear warp from the patch's units to pixels (affine, with the centre).
struct PatchPlace
{
    Vec2d centre;
    Matx22d warp;
};

//! One place or more where a patch may begin.
class PatchPlaces
{
public:
    void add(const PatchPlace& place) { places[count++] = place; }
    const PatchPlace* begin() const { return places; }
    const PatchPlace* end() const { return places + count; }

private:
    PatchPlace places[4];
    int count = 0;
};

struct PatchAlignment
{
    bool accepted;
    Vec2d point;        //!< in the second image, pixels
    double similarity;  //!< correlation of the two patches
    Matx22d covariance;
    Matx22d warp;  //!< of the surroundings, from the first image to the second
};

//! Smooths a normalized image; the result is a part of a larger one, where its border is repeated.
Mat preparedForAlignment(const Mat& normalized);

/** A coarse look at two images around points inside them: false where they hardly agree, which PatchAligner would take much
 longer to see. @param warp from the first image's surroundings to the second's. */
bool mayAgree(
        const Mat& image1, const Vec2d& point1, const Mat& image2, const Vec2d& point2, const Matx22d& warp);

//! Least-squares matching of patches, one after the other: what a thread needs for that.
class PatchAligner
{
public:
    PatchAligner();

    /** Takes the surroundings of a point of the first image, which is prepared by preparedForAlignment() as the second
     one.
     @param point inside the image.
     @param unit of the patch, in pixels of the first image, up to 1. */
    void take(const Mat& image1, const Vec2d& point, double unit);

    /** Finds where these surroundings are in the second image.
     @param starts places of the point inside the image; the one that agrees best is taken.
     @param least similarity that the start is above; more than 0 for a try, which ends early where it leads nowhere. */
    PatchAlignment align(const Mat& image2, const PatchPlaces& starts, double least);

private:
    struct Moments
    {
        double sums[SUMS];       //!< of the samples less their mean, times weights, from SUM_TEMPLATE on
        double mean, deviation;  //!< of the samples
    };

    Vec2d readTemplate(const Mat& image, const Vec2d& point);
    void readWindow(const Mat& image, const PatchPlace& place);
    bool sampleAt(const PatchPlace& place);
    Moments momentsOf(const short* values) const;
    double similarityOf(const Moments& moments) const;
    bool hasContrast();
    bool solve();
    Vec6d step(const Moments& moments) const;
    Vec2d interpolationError(const PatchPlace& place) const;
    Matx22d withoutNoise(const Matx22d& ofPoint, const Matx<double, 6, 2>& ofParameters, double noise,
            const Autocorrelation& ofResiduals) const;
    Matx22d covariance(const Moments& moments) const;

    const RefinementKernels& kernels;
    const PatchWeights& weights;
    PatchTemplate patch;
    const uchar* pixels1;  //!< that it was made of, TEMPLATE x TEMPLATE
    size_t step1;
    uchar resampled[TEMPLATE * TEMPLATE];
    double unit;   //!< of the patch
    Vec2d beside;  //!< where the point is from the patch's centre, in its units
    bool usable;   //!< whether the patch can tell a place, as far as is known
    bool solved;   //!< whether `inverse` is known
    Moments ofTemplate;
    double totals[SUMS];        //!< of the weights
    double independentSamples;  //!< as many as the weighted ones are worth
    double squaredPlace;        //!< weighted mean of PatchWeights::x squared
    Matx66d inverse;            //!< of the normal matrix
    Rect pixels;                //!< of the image that the window holds
    AlignedBuffer<ushort> window;
    AlignedBuffer<short> samples, ones;
};

}}  // namespace cv::iib
