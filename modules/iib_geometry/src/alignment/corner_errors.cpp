// SPDX-License-Identifier: Apache-2.0
#include "corner_errors.hpp"

#include "../pose/uncertainty.hpp"

namespace cv::iib {
namespace {

const double ANY = 1e3;  // deviation of a number of a transform
/* Pixels by which all matches of images that are moved by half a pixel may be off: patches that were sampled elsewhere are smoother
(Schreier, Braasch and Sutton 2000). */
const double RESAMPLED = .05;
const double NEIGHBOURS = .03;  // correlation of a part's matches, since patches of neighbours overlap
const double WIDER = 4;         // variance of what all have in common over that of what a part has

//! What the errors of matches have in common with those of other matches.
struct Correlation
{
    double inParts =
            0;  //!< of matches in one part of the image beyond that of neighbours, at least the deviation of this estimate
    double variance2 = 0;  //!< of what all may have in common, pixels^2
};

/** By how much more the sums of the errors of the parts of the image vary than noise of independent matches would let them. */
Correlation correlationOf(const FittedTransform& fitted, const std::vector<int>& parts)
{
    std::vector<Row<PlanarProblem::Step>> rows;
    const double scale2 = square(fitted.fit.scale);
    fitted.problem.linearize(fitted.fit.model, FARTHEST * scale2, rows);
    struct Part
    {
        Vec2d sum;
        double count = 0;
    };
    std::vector<Part> all(PARTS_ACROSS * PARTS_DOWN);
    double squares = 0, pairs = 0, counts2 = 0, excess = 0;
    for (size_t i = 0; i < rows.size(); i++)  // x and y of each match
    {
        const double influence = rows[i].r / (1 + rows[i].r2 / scale2);
        all[parts[rows[i].match]].sum[(int)(i % 2)] += influence;
        all[parts[rows[i].match]].count += .5;
        squares += square(influence) / (double)rows.size();
    }
    for (const Part& part : all)
    {
        excess += part.sum.dot(part.sum) - 2 * part.count * squares;
        pairs += 2 * part.count * (part.count - 1);
        counts2 += 2 * square(part.count);
    }
    Correlation result;
    if (pairs <= 0)
        result.inParts = 1;
    else if (squares > 0)
    {
        const double more = std::clamp(excess / (pairs * squares) - NEIGHBOURS, 0., 1.);
        result.inParts = std::min(std::max(more, std::sqrt(2 * counts2) / pairs), 1.);
        result.variance2 = WIDER * more * squares;
    }
    return result;
}

//! Mean of what is resampled, 0 (no match is moved by a part of a pixel) to 1.
double resampledShare(const FittedTransform& fitted, const AlignedPoints& points, double pixel)
{
    const Matx33d transform = fitted.transform();
    double sum = 0, count = 0;
    for (size_t i = 0; i < fitted.agree.size(); i++)
        if (fitted.agree[i])
        {
            const Point2d from = points.image.at<Point2d>((int)i),
                          by = (moved(transform, from) - from) / pixel;
            sum += square(std::sin(CV_PI * by.x)) + square(std::sin(CV_PI * by.y));
            count += 2;
        }
    return sum / std::max(count, 1.);
}

}  // namespace

Mat cornerErrors(const FittedTransform& fitted, const AlignedPoints& points,
        const std::vector<Point2d>& corners, double beside, double pixel)
{
    const std::vector<int> parts = partsOf(points.reference);
    const Correlation correlation = correlationOf(fitted, parts);
    const Square<PlanarProblem::Step> covariance =
            covarianceOf(fitted.problem, fitted.fit, parts, ANY, correlation.inParts);
    // What all matches have in common does not show in their errors: as much as those of a part are seen to have.
    const double common =
            2 * correlation.variance2 + 2 * square(RESAMPLED * pixel) * resampledShare(fitted, points, pixel);
    Mat errors(4, 1, CV_64F);
    for (int k = 0; k < 4; k++)
        errors.at<double>(k) = std::hypot(fitted.problem.deviation(fitted.fit.model, covariance, corners[k]),
                std::hypot(std::sqrt(common), beside));
    return errors;
}

}  // namespace cv::iib
