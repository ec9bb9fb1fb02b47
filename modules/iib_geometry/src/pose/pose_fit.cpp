// SPDX-License-Identifier: Apache-2.0
#include "pose_fit.hpp"

#include "../verdict/pose_tests.hpp"

namespace cv::iib {
namespace {

typedef std::vector<double> Errors;

const int THRESHOLDS = 7;
const double FIRST_THRESHOLD = 1.4;   // scales
const double RANGE = 12;              // ratio of the last threshold to the first
const double FARTHEST_AGREEING = 12;  // scales: largest error of a match to sample from
const double UNSURE = 4;              // factor by which an estimated scale may be wrong
const int FEWEST = 100, FEW_TRIALS = 1000, MANY_TRIALS = 500, MOST_TRIALS = 12000;
const int ROUNDS = 3;               // of sampling from the best pose's inliers, at most
const double BETTER = .99;          // another round follows if the best sum falls below this share of it
const double MOST_OF_REFINED = .6;  // pixels: largest scale of refined matches
const double WIDER = 4;             // factor from one scale to the next
const int FEW = 30;                 // matches: the final fit uses all if fewer agree
const int MANY = 60;                // matches: no pose fits most of them closer than they are

/** The first threshold for comparing poses. A pose that may be wrong gives too large a scale, so many matches are also compared by smaller
thresholds. Among few matches these would prefer a pose that fits some of them closely.
@param given whether the scale comes from the caller. */
double firstThreshold(const EpipolarProblem& problem, bool given, double scale)
{
    return given || problem.size() < MANY ? FIRST_THRESHOLD * scale : std::max(REFINED, scale / UNSURE);
}

//! The sum of the squared errors, cut off at thresholds from `first` to RANGE times `first`.
double misfit(const Errors& squared, double first, const Errors& weights)
{
    double perThreshold2[THRESHOLDS], sum = 0;
    for (int k = 0; k < THRESHOLDS; k++)
        perThreshold2[k] = 1 / square(first * std::pow(RANGE, k / (THRESHOLDS - 1.)));
    for (size_t i = 0; i < squared.size(); i++)
    {
        double each = 0;
        for (double per : perThreshold2)
            each += std::min(squared[i] * per, 1.);
        sum += weights.empty() ? each : each * weights[i];
    }
    return sum;
}

struct Candidate
{
    RelativePose pose;
    Errors squared;
    double sum;

    bool operator<(const Candidate& other) const { return sum < other.sum; }
};

Candidate candidateOf(
        const EpipolarProblem& problem, const RelativePose& pose, double first, const Errors& weights)
{
    Candidate candidate = {pose, {}, 0};
    problem.squaredErrors(pose, candidate.squared);
    candidate.sum = misfit(candidate.squared, first, weights);
    return candidate;
}

/** The best pose of a search, and the other candidates.
@param unit scale of the search, pixels.
@param first threshold for comparing poses.
@param farthest largest error of an inlier, pixels: in a wider band, any match of nearby points agrees. */
PoseFit fitBy(const EpipolarProblem& problem, const Verdict& verdict, double unit, double first,
        double farthest, Search<EpipolarProblem>& search, int trials, const Errors& weights)
{
    PoseFit fit;
    std::vector<Candidate> candidates;
    const auto add = [&](const std::vector<RelativePose>& poses) {
        const size_t count = candidates.size();
        candidates.resize(count + poses.size());
        inParallel(poses.size(),
                [&](size_t i) { candidates[count + i] = candidateOf(problem, poses[i], first, weights); });
        std::stable_sort(candidates.begin(), candidates.end());
    };
    add(search.upTo(trials));
    if (candidates.empty())
        return fit;
    for (int round = 0; round < ROUNDS && search.samples() >= MANY_TRIALS; round++)
    {
        // Few samples from all matches are free of wrong ones. Many are, if taken from the best pose's inliers.
        std::vector<int> agree;
        for (int i = 0; i < problem.size(); i++)
            if (candidates[0].squared[i] < square(FARTHEST_AGREEING * unit))
                agree.push_back(i);
        const Loss wide{1.2 * unit, 50};  // up to eight and a half scales
        const double before = candidates[0].sum;
        add(Search<EpipolarProblem>(problem, wide, wide, FEWEST, agree).upTo(FEWEST));
        if (candidates[0].sum > BETTER * before)
            break;
    }
    std::vector<RelativePose> narrow;
    for (size_t i = 0; i < std::min<size_t>(candidates.size(), 3); i++)
        narrow.push_back(candidates[i].pose);
    inParallel(narrow.size(), [&](size_t i) { polish(problem, Loss{unit}, ROUGHLY, narrow[i]); });
    add(narrow);
    fit.model = candidates[0].pose;
    fit.squared.swap(candidates[0].squared);
    for (size_t i = 1; i < candidates.size(); i++)
        fit.others.push_back(candidates[i].pose);
    std::vector<double> limits;
    for (double scales : {1.5, 3., 6., FARTHEST_AGREEING})
        limits.push_back(std::min(scales * unit, farthest));
    const Matx33d essential = essentialOf(fit.model);
    const Errors wrong = errorsOfWrongMatches(verdict,
            [&](int i, int j) { return problem.squaredError(fit.model, essential, i, j, limits.back()); });
    fit.logFalseAlarms = verdict.logFalseAlarms(
            fit.squared, wrong, Verdict::FROM_LINE, problem.sampleSize(), limits, &fit.limit);
    fit.chance = verdict.chance(Verdict::FROM_LINE, fit.limit, wrong);
    return fit;
}

//! The best pose of a search at the given scale. Without one, scales get wider until the inliers are significant.
PoseFit searchPose(
        const EpipolarProblem& problem, const Verdict& verdict, double scale, const Errors& weights)
{
    PoseFit best;
    int samples = 0;
    const std::vector<int> likely = problem.alikeTheirNeighbours(verdict.firstOfPlaces());
    const double farthest = scale > 0 ? FARTHEST_AGREEING * scale : .75 * problem.mostScale();
    const auto isCertain = [&] { return best.logFalseAlarms < Verdict::CERTAIN; };
    const auto isBetter = [&](const PoseFit& fit) {
        if (!isCertain() || fit.logFalseAlarms > Verdict::CERTAIN)
            return best.squared.empty() || fit.logFalseAlarms < best.logFalseAlarms;
        const double first = firstThreshold(problem, scale > 0, std::min(fit.scale, best.scale));
        return misfit(fit.squared, first, weights) < misfit(best.squared, first, weights);
    };
    const auto tryBy = [&](double unit, int fewTrials, int mostTrials) {
        Search<EpipolarProblem> search(problem, Loss{unit}, Loss{2 * unit}, FEWEST, {}, likely);
        for (int trials : {fewTrials, mostTrials})
        {
            PoseFit fit = fitBy(problem, verdict, unit, firstThreshold(problem, scale > 0, unit), farthest,
                    search, trials, weights);
            fit.scale = scale > 0 ? scale : scaleWithin(fit.squared, fit.limit, problem.parameters());
            if (isBetter(fit))
                best = fit;
            // Matches that were not refined are found faster at a wider scale.
            if (!search.wantsMore() || trials == mostTrials || (isCertain() && fit.scale > MOST_OF_REFINED))
                break;
        }
        samples += search.samples();
    };
    if (scale > 0)
        tryBy(scale, MOST_TRIALS, MOST_TRIALS);
    else
    {
        tryBy(REFINED, FEW_TRIALS, MOST_TRIALS);
        bool isWide = isCertain() && best.scale > MOST_OF_REFINED;
        for (double unit = WIDER * REFINED; (isWide || !isCertain()) && unit <= problem.mostScale();
                unit *= WIDER)
        {
            tryBy(unit, FEW_TRIALS, FEW_TRIALS);
            isWide = false;
        }
    }
    const auto agreeing = [](const PoseFit& fit) { return countOf(within(fit.limit, fit.squared)); };
    if (scale == 0 && problem.size() < FEW)
    {
        // With few matches, a pose may fit some so closely that the others seem wrong. A wider scale avoids this.
        const PoseFit narrow = best;
        best = PoseFit();
        tryBy(WIDER * REFINED, FEW_TRIALS, FEW_TRIALS);
        if (!isCertain() || agreeing(best) < agreeing(narrow))
            best = narrow;
    }
    best.samples = samples;
    return best;
}

/** Polishes the other poses that may explain the matches: the other poses of a plane, the pose with -t, and candidates that differ
from the pose and from each other. */
void addOthers(const EpipolarProblem& problem, PoseFit& fit)
{
    const size_t most = 6;
    std::vector<RelativePose> all = problem.rivals(fit.model, fit.scale);
    const size_t planar = all.size();
    all.push_back({fit.model.R, -fit.model.t});
    all.insert(all.end(), fit.others.begin(), fit.others.end());
    fit.others.clear();
    for (size_t k = 0; k < all.size(); k++)
    {
        const auto isApart = [&](const RelativePose& other) { return problem.areApart(all[k], other); };
        if (fit.others.size() < most && isApart(fit.model) &&
                std::all_of(fit.others.begin(), fit.others.end(), isApart))
            fit.others.push_back(all[k]);
        if (k < planar)
            fit.planar = fit.others.size();
    }
    inParallel(
            fit.others.size(), [&](size_t i) { polish(problem, Loss{fit.scale}, ROUGHLY, fit.others[i]); });
}

//! The scale estimated from the errors, if it is wider than `scale`.
double widerScale(const EpipolarProblem& problem, const Errors& squared, double scale)
{
    for (double wider = scale, shown; wider <= problem.mostScale(); wider *= 2)
        if (findScale(squared, FARTHEST_OF_CHOICE * wider, problem.parameters(), shown))
            return std::max(shown, scale);
    return scale;
}

//! Polishes the pose by its inliers without those that are probably wrong; by all matches if that leaves few.
void polishByAgreeing(const EpipolarProblem& problem, double scale, PoseFit& fit)
{
    fit.errorScale = fit.limit < 6 * fit.scale ? fit.scale : fit.limit / 3;
    if (scale > 0)
        fit.errorScale = std::max(fit.errorScale, widerScale(problem, fit.squared, fit.scale));
    fit.used = withinByMoreThanChance(fit.squared, problem.parallaxes(fit.model), 3 * fit.errorScale);
    if (countOf(fit.used) < FEW)
    {
        fit.used.assign(problem.size(), true);
        if (scale == 0)  // the scale estimated from few matches is too narrow
            fit.scale = fit.errorScale = std::max(fit.errorScale, fit.limit / 3);
    }
    polish(problem.subset(fit.used), Loss{fit.scale}, FINELY, fit.model);
    problem.squaredErrors(fit.model, fit.squared);
}

}  // namespace

PoseFit fitPose(const EpipolarProblem& problem, const Verdict& verdict, double scale, const Errors& weights)
{
    PoseFit best = searchPose(problem, verdict, scale, weights);
    if (best.squared.empty())
        return best;
    if (scale == 0)
        best.scale = widerScale(problem, best.squared, best.scale);
    polish(problem, Loss{best.scale}, ROUGHLY, best.model);
    problem.squaredErrors(best.model, best.squared);
    addOthers(problem, best);
    const double first = firstThreshold(problem, scale > 0, best.scale);
    double least = misfit(best.squared, first, weights);
    for (RelativePose& other : best.others)  // near a polished pose there may be a better one
    {
        const Candidate candidate = candidateOf(problem, other, first, weights);
        if (candidate.sum >= least)
            continue;
        least = candidate.sum;
        other = best.model;
        best.model = candidate.pose;
    }
    problem.squaredErrors(best.model, best.squared);
    polishByAgreeing(problem, scale, best);
    return best;
}

}  // namespace cv::iib
