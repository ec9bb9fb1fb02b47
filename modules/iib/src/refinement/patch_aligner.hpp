// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#pragma once

#include "../common/aligned_buffer.hpp"
#include "kernels/kernels.hpp"

namespace cv { namespace iib {

//! A patch on an image: its centre in pixels, and the linear warp from the patch's units to pixels.
struct PatchPlace
{
    Vec2d centre;
    Matx22d warp;
};

//! One to four start places of a patch.
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

//! Smooths a normalized image; the result is a view of a larger image, which repeats its border pixels.
Mat preparedForAlignment(const Mat& normalized);

/** Compares two images coarsely around points inside them. False: PatchAligner would refuse the match, but take longer.
 @param warp from the first image's surroundings to the second's. */
bool roughlyAgree(
        const Mat& image1, const Vec2d& point1, const Mat& image2, const Vec2d& point2, const Matx22d& warp);

//! Least-squares matching of patches, one after the other, on one thread.
class PatchAligner
{
public:
    PatchAligner();

    /** Sets the patch to search for: the surroundings of a point of the first image.
     @param image1 made by preparedForAlignment(), as image2 below.
     @param point inside the image.
     @param unit of the patch, in pixels of the first image, up to 1. */
    void setTemplate(const Mat& image1, const Vec2d& point, double unit);

    /** Finds the patch in the second image.
     @param starts places of the point inside the image; the most similar one is used.
     @param least similarity that the start must exceed. Above 0, steps also end early if the similarity stays low. */
    PatchAlignment align(const Mat& image2, const PatchPlaces& starts, double least);

private:
    struct Moments
    {
        double sums[SUMS];  //!< weighted sums of (sample - mean), from SUM_TEMPLATE on
        double mean, deviation;
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
    const uchar* pixels1;  //!< the TEMPLATE x TEMPLATE pixels of the patch
    size_t step1;
    uchar resampled[TEMPLATE * TEMPLATE];
    double unit;        //!< of the patch, in pixels of the first image
    Vec2d pointOffset;  //!< of the point from the patch's centre, in its units
    bool usable;        //!< false: the patch is known to have too little contrast
    bool solved;        //!< whether `inverse` is set
    Moments ofTemplate;
    double totals[SUMS];        //!< sums of the weights
    double independentSamples;  //!< effective number of samples
    double squaredPlace;        //!< weighted mean of PatchWeights::x squared
    Matx66d inverse;            //!< of the normal matrix
    Rect pixels;                //!< those of the second image that the window holds
    AlignedBuffer<ushort> window;
    AlignedBuffer<short> samples, ones;
};

}}  // namespace cv::iib
