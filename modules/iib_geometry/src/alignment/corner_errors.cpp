// SPDX-License-Identifier: Apache-2.0
#include "../pose/uncertainty.hpp"
#include "judgement.hpp"

namespace cv::iib {
namespace {

const double ANY = 1e3;  // largest deviation of a transform's parameter
/* Pixels by which all matches may be off where one image is moved by half a pixel, since patches that were resampled are smoother
(Schreier, Braasch and Sutton 2000). */
const double RESAMPLED = .085;
const double NEIGHBOURS = .03;  // correlation of a part's matches, since patches of neighbours overlap
const double WIDER = 4;  // variance of the error that all matches share, over that of the matches of one part

//! Errors that matches share.
struct Correlation
{
    //! Correlation of the matches in one part of the image, beyond that of neighbours; at least its own standard deviation.
    double inParts = 0;
    double common2 = 0;  //!< variance of the error that all matches may share, pixels^2
};

//! From the variance of the parts' mean errors, over that of independent matches.
Correlation correlationOf(const FittedTransform& fitted, const std::vector<int>& parts)
{
    std::vector<Row<PlanarProblem::Step>> rows;
    const double scale2 = square(fitted.fit.scale);
    fitted.problem.linearize(fitted.fit.model, FARTHEST * scale2, rows);
    std::vector<Vec3d> all(PARTS_ACROSS * PARTS_DOWN);  // sums of x and y errors, and number of matches
    double squares = 0, pairs = 0, counts2 = 0, excess = 0;
    for (size_t i = 0; i < rows.size(); i++)  // x and y of each match
    {
        const double influence = rows[i].r / (1 + rows[i].r2 / scale2);
        all[parts[rows[i].match]] += i % 2 ? Vec3d(0, influence, .5) : Vec3d(influence, 0, .5);
        squares += square(influence) / (double)rows.size();
    }
    for (const Vec3d& part : all)
    {
        excess += square(part[0]) + square(part[1]) - 2 * part[2] * squares;
        pairs += 2 * part[2] * (part[2] - 1);
        counts2 += 2 * square(part[2]);
    }
    Correlation result;
    if (pairs <= 0)
        result.inParts = 1;
    else if (squares > 0)
    {
        const double more = std::clamp(excess / (pairs * squares) - NEIGHBOURS, 0., 1.);
        result.inParts = std::clamp(std::sqrt(2 * counts2) / pairs, more, 1.);
        result.common2 = WIDER * more * squares;
    }
    return result;
}

//! 0 if all matches are moved by whole pixels, up to 1 if by half pixels.
double resampledShare(const FittedTransform& fitted, const AlignedPoints& points, double pixel)
{
    const Points images = marked(points, fitted.agree).image;
    const Matx33d transform = fitted.transform();
    double sum = 0;
    for (const Point2d& from : images)
    {
        const Point2d by = (moved(transform, from) - from) / pixel;
        sum += square(std::sin(CV_PI * by.x)) + square(std::sin(CV_PI * by.y));
    }
    return sum / std::max(2. * (double)images.size(), 1.);
}

}  // namespace

Mat cornerErrors(const FittedTransform& fitted, const AlignedPoints& points,
        const std::vector<Point2d>& corners, double beside, double pixel)
{
    const std::vector<int> parts = partsOf(points.reference);
    const Correlation correlation = correlationOf(fitted, parts);
    const Square<PlanarProblem::Step> covariance =
            covarianceOf(fitted.problem, fitted.fit.model, fitted.fit.scale, parts, ANY, correlation.inParts);
    // An error that all matches share does not show in their residuals; the parts' errors show how large it may be.
    const double common =
            2 * correlation.common2 + 2 * square(RESAMPLED * pixel) * resampledShare(fitted, points, pixel);
    Mat errors(4, 1, CV_64F);
    for (int k = 0; k < 4; k++)
        errors.at<double>(k) = std::hypot(fitted.problem.deviation(fitted.fit.model, covariance, corners[k]),
                std::hypot(std::sqrt(common), beside));
    return errors;
}

}  // namespace cv::iib
