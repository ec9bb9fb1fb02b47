// SPDX-License-Identifier: Apache-2.0
#include "fitted_transform.hpp"

#include <numeric>

#include "opencv2/iib/alignment.hpp"

namespace cv::iib {
namespace {

/* Log likelihood that refutes a simpler model, per additional parameter and per inlier. True models gain up to 3.9 per parameter or .23 per inlier
by noise and lens distortion; untrue ones with underestimated errors gain 5.3 and .29 (103 pairs under changed illumination, each model). */
const double LEAST_GAIN = 4.5, LEAST_GAIN_OF_MATCH = .24;
const double WIDE = 8;      // first scale of a fit from a richer transform, working pixels
const size_t ENOUGH = 200;  // matches for the wide scales
// A transform of another part loses log likelihood on inliers of the simple one, and most of them. A true one keeps nine of ten.
const double LEAST_LOSS = .1, MOST_SHARED = .8;

//! The affine part at the origin, reduced to a model.
Matx33d simplified(const Matx33d& model, int kind)
{
    if (kind == ALIGN_HOMOGRAPHY)
        return model;
    const Matx33d affine = affineAt(model, Point2d());
    if (kind == ALIGN_TRANSLATION)
        return {1, 0, affine(0, 2), 0, 1, affine(1, 2), 0, 0, 1};
    return kind == ALIGN_SIMILARITY ? similarityOf(affine) : affine;
}

//! Log likelihood that the richer transform gains on each match.
std::vector<double> gains(const FittedTransform& richer, const FittedTransform& simple)
{
    const double scale2 = square(richer.limit / 3);
    const auto loss = [&](double squared) { return std::log1p(std::min(squared / scale2, FARTHEST)); };
    std::vector<double> result;
    for (size_t i = 0; i < simple.fit.squared.size(); i++)
        result.push_back(loss(simple.fit.squared[i]) - loss(richer.fit.squared[i]));
    return result;
}

//! ENOUGH of the matches or more.
AlignedPoints thinned(const AlignedPoints& points)
{
    Verdict::Marks some(points.image.size());
    for (size_t i = 0; i < some.size(); i += std::max<size_t>(some.size() / ENOUGH, 1))
        some[i] = true;
    return marked(points, some);
}

int moreParameters(const FittedTransform& richer, const FittedTransform& simple)
{
    return richer.problem.parameters() - simple.problem.parameters();
}

}  // namespace

const char* nameOf(int model)
{
    const char* const names[] = {"TRANSLATION", "SIMILARITY", "AFFINE", "HOMOGRAPHY"};
    return names[model];
}

FittedTransform::FittedTransform(const AlignedPoints& points, int kind, int mostTrials)
    : model(kind), problem(points.reference, points.image, kind), fit(robustFit(problem, mostTrials)),
      limit(3 * std::max(fit.scale, REFINED)), agree(within(limit, fit.squared))
{
    agree.resize(problem.size());
}

FittedTransform::FittedTransform(const AlignedPoints& points, int kind, const Matx33d& from, double scale)
    : model(kind), problem(points.reference, points.image, kind), limit(3 * REFINED), agree(problem.size())
{
    if (problem.size() < problem.sampleSize())
        return;
    fit.model = simplified(problem.fromPixels(from), kind);
    if ((size_t)problem.size() > 2 * ENOUGH && scale > 2 * REFINED)
    {
        fit.model = problem.fromPixels(FittedTransform(thinned(points), kind, from, scale).transform());
        scale = REFINED;
    }
    for (; scale > REFINED; scale /= 2)
        polish(problem, Loss{scale}, ROUGHLY, fit.model);
    bool found = false;
    for (scale = REFINED; !found && scale <= 2 * REFINED; scale *= 2)
    {
        polish(problem, Loss{scale}, ROUGHLY, fit.model);
        problem.squaredErrors(fit.model, fit.squared);
        found = findScale(fit.squared, FARTHEST_OF_CHOICE * scale, problem.parameters(), fit.scale);
        if (!found)
            fit.scale = scale;
    }
    polish(problem, Loss{fit.scale}, FINELY, fit.model);
    problem.squaredErrors(fit.model, fit.squared);
    limit = 3 * std::max(fit.scale, REFINED);
    agree = within(limit, fit.squared);
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

bool FittedTransform::isSignificant(const Evidence& evidence) const
{
    const Verdict& verdict = evidence.verdict;
    const auto errorOf = [&](int i, int j) { return problem.squaredError(fit.model, i, j); };
    return verdict.logFalseAlarms(fit.squared, errorsOfWrongMatches(verdict, errorOf), Verdict::FROM_POINT,
                   problem.sampleSize(), {.5 * limit, limit, 2 * limit, 4 * limit}) +
                   std::log10((double)evidence.tried) <
           Verdict::CERTAIN;
}

std::vector<FittedTransform> fittedTransforms(const Evidence& evidence, int model)
{
    const AlignedPoints& points = evidence.points;
    std::vector<FittedTransform> fitted;
    FittedTransform richest(points, ALIGN_HOMOGRAPHY);
    const bool isRich = model != ALIGN_HOMOGRAPHY && richest.exists() && richest.isSignificant(evidence);
    for (int kind = model == ALIGN_AUTO ? ALIGN_TRANSLATION : model; kind < ALIGN_HOMOGRAPHY; kind++)
        if (isRich && kind != model)
        {
            const Matx33d from = kind == ALIGN_TRANSLATION
                                         ? FittedTransform(thinned(points), kind).transform()
                                         : richest.transform();
            fitted.emplace_back(points, kind, from, WIDE);
        }
        else
            fitted.emplace_back(points, kind);
    fitted.push_back(std::move(richest));
    return fitted;
}

std::vector<FittedTransform> fittedTransforms(const AlignedPoints& points, const FittedTransform& coarse)
{
    std::vector<FittedTransform> fitted;
    for (int kind = coarse.model; kind <= ALIGN_HOMOGRAPHY; kind++)
        fitted.emplace_back(points, kind, coarse.transform(), 2 * REFINED);
    return fitted;
}

double gainOf(const FittedTransform& richer, const FittedTransform& simple)
{
    if (!richer.exists())
        return 0;
    std::vector<double> each = gains(richer, simple);
    const int more = moreParameters(richer, simple);
    const auto last = each.begin() + std::min<size_t>(more, each.size());
    std::partial_sort(each.begin(), last, each.end(), std::greater<double>());
    return std::accumulate(last, each.end(), 0.) / more;
}

bool isBetter(const FittedTransform& richer, const FittedTransform& simple)
{
    const double gain = gainOf(richer, simple);
    return gain > LEAST_GAIN && gain * moreParameters(richer, simple) > LEAST_GAIN_OF_MATCH * richer.count();
}

bool isOfAnotherPart(const FittedTransform& richer, const FittedTransform& simple)
{
    const std::vector<double> each = gains(richer, simple);
    double gain = 0;
    int both = 0;
    for (size_t i = 0; i < each.size(); i++)
        if (simple.agree[i])
        {
            gain += each[i];
            both += richer.agree[i];
        }
    return gain < -LEAST_LOSS * simple.count() && both < MOST_SHARED * simple.count();
}

int simplestModel(const FittedTransform& fitted, const AlignedPoints& points)
{
    int model = ALIGN_TRANSLATION;
    while (model < fitted.model && gainOf(fitted, FittedTransform(points, model, fitted)) > NEEDED_GAIN)
        model++;
    return model;
}

}  // namespace cv::iib
