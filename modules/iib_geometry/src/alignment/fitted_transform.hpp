// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "../pose/planar_problem.hpp"
#include "../verdict/verdict.hpp"
#include "working_pair.hpp"

namespace cv::iib {

//! Of an AlignmentModel, but ALIGN_AUTO.
const char* nameOf(int model);

//! A transform that was fitted to two images' matches, in working pixels, and which of them agree with it.
struct FittedTransform
{
    int model;  //!< AlignmentModel
    PlanarProblem problem;
    Fit<PlanarProblem> fit;
    Verdict::Marks agree;
    double limit;  //!< of the distances of matches that agree

    //! That most matches agree with.
    FittedTransform(const AlignedPoints& points, int model);

    //! Near a transform of more freedom.
    FittedTransform(const AlignedPoints& points, int model, const FittedTransform& richer);

    bool exists() const { return !fit.squared.empty(); }
    int count() const { return (int)std::count(agree.begin(), agree.end(), true); }
    Matx33d transform() const { return problem.inPixels(fit.model); }

    //! @param tried number of views in which the images were matched.
    bool isCertain(const Verdict& verdict, int tried) const;
};

//! The matches that are marked.
AlignedPoints marked(const AlignedPoints& points, const Verdict::Marks& marks);

//! Transforms of a kind and of all kinds with more freedom, the one with most freedom last.
std::vector<FittedTransform> fittedTransforms(const AlignedPoints& points, int simplest);

/** By how much a transform of more freedom explains the matches better than noise and a few wrong matches would let it, by the likelihood of their
errors, as Cauchy's loss under the scale of the richer one has it: for each number that it has more. */
double gainOf(const FittedTransform& richer, const FittedTransform& simple);

const double NEEDED_GAIN = 2;  // of a true transform that needs its freedom

//! Whether the simple transform is refuted by that, though lenses bend images a little.
bool isBetter(const FittedTransform& richer, const FittedTransform& simple);

/** Whether the richer transform is that of something else: it moves away from the matches that agree with the simple one. A transform of
more freedom that is true comes nearer to them. */
bool isOfAnotherPart(const FittedTransform& richer, const FittedTransform& simple);

//! The AlignmentModel of least freedom that explains the matches of a transform as well.
int simplestModel(const FittedTransform& fitted, const AlignedPoints& points);

}  // namespace cv::iib
