// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "../pose/planar_problem.hpp"
#include "../verdict/verdict.hpp"
#include "working_pair.hpp"

namespace cv::iib {

//! The matches of two images, and what their transforms are judged by. Errors are distances in the reference.
struct Evidence
{
    const AlignedPoints& points;
    const WorkingPair& pair;
    int tried;        //!< number of view pairs in which the images were matched
    Verdict verdict;  //!< of points in the image and in the reference
};

//! @param model AlignmentModel except ALIGN_AUTO.
const char* nameOf(int model);

//! A transform fitted to the matches of two images, in working pixels, and the matches that agree with it.
struct FittedTransform
{
    int model;  //!< AlignmentModel
    PlanarProblem problem;
    Fit<PlanarProblem> fit;
    double limit;  //!< largest distance of a match that agrees
    Verdict::Marks agree;

    //! The transform with which most matches agree.
    FittedTransform(const AlignedPoints& points, int model, int mostTrials = MANY_SAMPLES);

    /** A transform fitted from another one, of working pixels and of as much freedom or more.
    @param scale of the first fit, working pixels; the matches' own scale is estimated from there. */
    FittedTransform(const AlignedPoints& points, int model, const Matx33d& from, double scale);

    //! A transform with less freedom, fitted from a richer one and under its scale.
    FittedTransform(const AlignedPoints& points, int model, const FittedTransform& richer);

    bool exists() const { return !fit.squared.empty(); }
    int count() const { return countOf(agree); }
    Matx33d transform() const { return problem.inPixels(fit.model); }

    bool isSignificant(const Evidence& evidence) const;
};

/** The model and all richer ones; the homography is last.
@param model AlignmentModel; ALIGN_AUTO: all. */
std::vector<FittedTransform> fittedTransforms(const Evidence& evidence, int model);

//! The same of matches that all agree with a transform, after they were refined.
std::vector<FittedTransform> fittedTransforms(const AlignedPoints& points, const FittedTransform& coarse);

/** Log likelihood that a richer transform gains per additional parameter, by Cauchy's loss under the richer one's scale. The largest gains are
left out, as many as there are additional parameters: they may be wrong matches that the richer transform fits exactly. */
double gainOf(const FittedTransform& richer, const FittedTransform& simple);

const double NEEDED_GAIN = 2;  // of a true transform that needs its freedom

//! Whether the gain refutes the simple transform. Noise and lens distortion gain less.
bool isBetter(const FittedTransform& richer, const FittedTransform& simple);

/** Whether the richer transform belongs to another part of the images: it fits the inliers of the simple transform worse. A true richer model
fits them better. */
bool isOfAnotherPart(const FittedTransform& richer, const FittedTransform& simple);

//! The AlignmentModel of least freedom that explains the matches as well.
int simplestModel(const FittedTransform& fitted, const AlignedPoints& points);

}  // namespace cv::iib
