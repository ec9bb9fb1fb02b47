// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "robust_fit.hpp"

namespace cv::iib {

/* The covariance of a fitted model. Neighbouring matches have correlated errors, since their patches overlap and a shadow moves them
together. So the number of matches says little. The covariance is the sum of three parts:
- The noise of independent matches: the covariance of an M-estimator (Huber 1981, equation 7.6.2), with a factor for few matches.
- The change of the model when a part of the image is left out (delete-a-group jackknife; Shao and Tu 1995, section 2.3). One
  Newton step replaces a new fit, and a factor corrects for the few parts.
- A shift shared by all matches of a part, of SHARED times a match's variance. The jackknife measures it poorly. SHARED was chosen
  on rendered places under changed illumination (views.py --seed 21 22 23).
No part includes errors that all matches share. */

const int PARTS_ACROSS = 4, PARTS_DOWN = 3;
const double FEW_PARTS = 2.5;        // factor for a variance estimated from a dozen parts
const double SHARED = .2;            // of the variance of a match
const double LEAST_NOISE = .02;      // pixels: least standard deviation of a match
const double LARGEST_DEVIATION = 3;  // radians: standard deviation of an undetermined angle

//! The index of each point's part of the image. The parts divide the points' span.
inline std::vector<int> partsOf(const Points& points)
{
    const Rect2d span = spanOf(points);
    const auto part = [](double place, int parts) { return (int)std::clamp(place * parts, 0., parts - 1.); };
    std::vector<int> parts;
    for (const Point2d& p : points)
        parts.push_back(part((p.x - span.x) / span.width, PARTS_ACROSS) +
                        part((p.y - span.y) / span.height, PARTS_DOWN) * PARTS_ACROSS);
    return parts;
}

//! Sum of v f(v, value)' over the eigenvectors v of a symmetric matrix and their eigenvalues; f is of each entry of v.
template <int N, class Function>
Matx<double, N, N> ofEigenvalues(const Matx<double, N, N>& m, const Function& function)
{
    Matx<double, N, 1> values;
    Matx<double, N, N> vectors, scaled;
    eigen(m, values, vectors);
    for (int r = 0; r < N; r++)
        for (int c = 0; c < N; c++)
            scaled(r, c) = function(vectors(r, c), values(r));
    return vectors.t() * scaled;
}

/** Limits the standard deviations of a covariance.
@param rank least eigenvalue, as a share of the square of the largest deviation. Above 1e-15, the covariance is invertible. */
template <int N>
Matx<double, N, N> limited(const Matx<double, N, N>& covariance, double largest, double rank = 0)
{
    return ofEigenvalues(covariance, [&](double entry, double value) {
        return entry * std::clamp(value, rank * square(largest), square(largest));
    });
}

/** Covariance of the step from a fitted model to the true one.
@param scale of the loss that the model was fitted under, or a wider one, pixels.
@param parts partsOf() the matches.
@param largest standard deviation of a parameter, in its unit; undetermined parameters have it.
@param shared share of a match's variance that all matches of a part have in common. */
template <class Problem>
Square<typename Problem::Step> covarianceOf(const Problem& problem, const typename Problem::Model& model,
        double scale, const std::vector<int>& parts, double largest, double shared = SHARED)
{
    typedef typename Problem::Step Step;
    const double leastBend = .2;  // reached if the noise is far above the scale
    std::vector<Row<Step>> rows;
    const double perScale2 = 1 / square(scale);
    problem.linearize(model, FARTHEST * square(scale), rows);
    if (rows.empty())
        return Square<Step>::eye() * square(largest);

    // Sums of psi^2 and of psi's slope, with psi = weight r and weight = 1 / (1 + r^2 / scale^2).
    double influence2 = 0, slope = 0, weights = 0;
    for (const Row<Step>& row : rows)
    {
        const double weight = 1 / (1 + row.r2 * perScale2), psi = weight * row.r;
        influence2 += psi * psi;
        slope += weight - 2 * psi * psi * perScale2;
        weights += weight;
    }
    const double count = (double)rows.size(), freedom = std::max(count - problem.parameters(), 1.);
    const double bend = std::max(slope / weights, leastBend), meanSlope = bend * weights / count;
    // Noise estimated from few matches may be too small: F's quantiles over those of chi-squared.
    const double few = (std::max(freedom, 3.) + 2) / (std::max(freedom, 3.) - 2);
    const double noise2 = std::max(influence2 / freedom / square(meanSlope) * few, square(LEAST_NOISE));

    struct Part
    {
        Square<Step> hessian = Square<Step>::zeros();
        Step gradient, along;  //!< sums of weight r J, and of weight J
    };
    std::vector<Part> all(PARTS_ACROSS * PARTS_DOWN);
    Square<Step> hessian = Square<Step>::zeros(), ofGradient = hessian;  // covariance of the gradient
    const std::vector<Square<Step>> noises = problem.noiseInDerivatives(model, rows, noise2);
    for (size_t i = 0; i < rows.size(); i++)
    {
        const Row<Step>& row = rows[i];
        Part& part = all[parts[row.match]];
        const double weight = 1 / (1 + row.r2 * perScale2);
        addProduct(row.J, bend * weight, part.hessian);
        if (!noises.empty())
            part.hessian -= noises[i] * bend;
        addProduct(row.J, noise2 * square(meanSlope), ofGradient);
        part.gradient += weight * row.r * row.J;
        part.along += weight * row.J;
    }
    for (Part& part : all)
    {
        completeSymm(part.hessian, true);
        hessian += part.hessian;
        addProduct(part.along, shared * noise2, ofGradient);
    }
    completeSymm(ofGradient, true);
    const double least = noise2 / square(largest);
    const auto inverseOf = [&](const Square<Step>& m) {
        return ofEigenvalues(m, [&](double entry, double value) { return entry / std::max(value, least); });
    };
    const Square<Step> inverse = inverseOf(hessian), unknown = ofEigenvalues(hessian, [&](double entry,
                                                                                              double value) {
        return entry * std::clamp(1 - value / least, 0., 1.);  // how much inverseOf() raised the eigenvalue
    });

    std::vector<Step> changes;
    Step mean;
    for (const Part& part : all)
        if (part.hessian != Square<Step>::zeros())
        {
            changes.push_back(inverseOf(hessian - part.hessian) * part.gradient);
            mean += changes.back();
        }
    const double groups = (double)changes.size();
    Square<Step> spread = Square<Step>::zeros();
    for (const Step& change : changes)
        addProduct(Step(change - mean * (1 / groups)), FEW_PARTS * (groups - 1) / groups, spread);
    completeSymm(spread, true);
    return limited(inverse * ofGradient * inverse + spread + unknown * square(largest), largest);
}

}  // namespace cv::iib
