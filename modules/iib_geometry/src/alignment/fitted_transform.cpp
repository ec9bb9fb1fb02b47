// SPDX-License-Identifier: Apache-2.0
#include "fitted_transform.hpp"

#include <numeric>

#include "opencv2/iib/alignment.hpp"

namespace cv::iib {
namespace {

const double LEAST_SCALE = .25;  // by which matches count as agreeing, working pixels
/* By which a model that is true is better than one that is not, as logarithms of likelihoods, for each number that it has more, and for each
match. Noise and bent lenses have up to 3.9 of numbers, or .23 of matches; untrue models whose errors are underestimated 5.3 and .29
(103 pairs under other light, moved by transforms of each kind). */
const double LEAST_GAIN = 4.5, LEAST_GAIN_OF_MATCH = .24;
const double LEAST_LOSS = .1;  // of a match, by which a transform of something else is worse

//! The derivative at the origin as a transform of less freedom has it.
Matx33d simplified(const Matx33d& model, int kind)
{
    Matx33d affine = affineAt(model, Point2d());
    if (kind == ALIGN_TRANSLATION)
        affine(0, 0) = affine(1, 1) = 1, affine(0, 1) = affine(1, 0) = 0;
    else if (kind == ALIGN_SIMILARITY)
    {
        affine(0, 0) = affine(1, 1) = (affine(0, 0) + affine(1, 1)) / 2;
        affine(1, 0) = (affine(1, 0) - affine(0, 1)) / 2;
        affine(0, 1) = -affine(1, 0);
    }
    return affine;
}

std::vector<double> losses(const FittedTransform& fitted, double scale)
{
    std::vector<double> result;
    for (double squared : fitted.fit.squared)
        result.push_back(std::log1p(std::min(squared / square(scale), FARTHEST)));
    return result;
}

//! By how much the richer transform explains each match better.
std::vector<double> gains(const FittedTransform& richer, const FittedTransform& simple)
{
    std::vector<double> result = losses(simple, richer.limit / 3);
    const std::vector<double> less = losses(richer, richer.limit / 3);
    for (size_t i = 0; i < result.size(); i++)
        result[i] -= less[i];
    return result;
}

}  // namespace

const char* nameOf(int model)
{
    const char* const names[] = {"TRANSLATION", "SIMILARITY", "AFFINE", "HOMOGRAPHY"};
    return names[model];
}

FittedTransform::FittedTransform(const AlignedPoints& points, int kind)
    : model(kind), problem(points.reference, points.image, kind), fit(robustFit(problem, 0)),
      limit(3 * std::max(fit.scale, LEAST_SCALE))
{
    agree = within(limit, fit.squared);
    agree.resize(problem.size());
}

FittedTransform::FittedTransform(const AlignedPoints& points, int kind, const FittedTransform& richer)
    : model(kind), problem(points.reference, points.image, kind), limit(richer.limit)
{
    const double roughly = 1e-4;
    fit.model = simplified(richer.fit.model, kind);
    fit.scale = richer.fit.scale;
    polish(problem, Loss{fit.scale}, roughly, fit.model);
    problem.squaredErrors(fit.model, fit.squared);
    agree = within(limit, fit.squared);
}

AlignedPoints marked(const AlignedPoints& points, const Verdict::Marks& marks)
{
    AlignedPoints some;
    for (size_t i = 0; i < marks.size(); i++)
        if (marks[i])
        {
            some.reference.push_back(points.reference.row((int)i));
            some.image.push_back(points.image.row((int)i));
            some.sizes.push_back(points.sizes[i]);
        }
    return some;
}

bool FittedTransform::isCertain(const Verdict& verdict, int tried) const
{
    std::vector<double> limits;
    for (double times : {.5, 1., 2., 4.})
        limits.push_back(times * limit);
    const auto errorOf = [&](int i, int j) { return problem.squaredError(fit.model, i, j); };
    return verdict.logFalseAlarms(fit.squared, errorsOfWrongMatches(verdict, errorOf), Verdict::FROM_POINT,
                   problem.sampleSize(), limits) +
                   std::log10((double)tried) <
           Verdict::CERTAIN;
}

std::vector<FittedTransform> fittedTransforms(const AlignedPoints& points, int simplest)
{
    std::vector<FittedTransform> fitted;
    for (int model = simplest; model <= ALIGN_HOMOGRAPHY; model++)
        fitted.emplace_back(points, model);
    return fitted;
}

double gainOf(const FittedTransform& richer, const FittedTransform& simple)
{
    if (!richer.exists())
        return 0;
    std::vector<double> each = gains(richer, simple);
    // So many numbers more fit as many coordinates of wrong matches exactly.
    const int more = richer.problem.parameters() - simple.problem.parameters();
    const auto last = each.begin() + std::min<size_t>(more, each.size());
    std::partial_sort(each.begin(), last, each.end(), std::greater<double>());
    return std::accumulate(last, each.end(), 0.) / more;
}

bool isBetter(const FittedTransform& richer, const FittedTransform& simple)
{
    const double gain = gainOf(richer, simple);
    const int more = richer.problem.parameters() - simple.problem.parameters();
    return gain > LEAST_GAIN && gain * more > LEAST_GAIN_OF_MATCH * richer.count();
}

bool isOfAnotherPart(const FittedTransform& richer, const FittedTransform& simple)
{
    const std::vector<double> each = gains(richer, simple);
    double gain = 0;
    for (size_t i = 0; i < each.size(); i++)
        gain += simple.agree[i] ? each[i] : 0;
    return gain < -LEAST_LOSS * simple.count();
}

int simplestModel(const FittedTransform& fitted, const AlignedPoints& points)
{
    int model = ALIGN_TRANSLATION;
    while (model < fitted.model && gainOf(fitted, FittedTransform(points, model, fitted)) > NEEDED_GAIN)
        model++;
    return model;
}

}  // namespace cv::iib
