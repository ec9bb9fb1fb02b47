// SPDX-License-Identifier: Apache-2.0
#include "pose_fit.hpp"

namespace cv::iib {
namespace {

typedef std::vector<double> Errors;

const double FIRST_THRESHOLD = 1.4, LAST_THRESHOLD = 12;  // scales
const int THRESHOLDS = 7;
const double FINELY = 1e-9, ROUGHLY = 1e-3;  // by how much less of its loss a pose is polished
const int FEWEST = 100, FEW_TRIALS = 1000, MANY_TRIALS = 500, MOST_TRIALS = 12000;
const double MOST_OF_REFINED = .6;  // pixels: more tells of matches that are not refined
const double WIDER = 4;             // one scale that is tried over the one before

//! What the errors of a pose amount to: the sum over all thresholds.
double misfit(const Errors& squared, double scale, const Errors& weights)
{
    double perThreshold2[THRESHOLDS], sum = 0;
    for (int k = 0; k < THRESHOLDS; k++)
        perThreshold2[k] = 1 / square(scale * FIRST_THRESHOLD *
                                       std::pow(LAST_THRESHOLD / FIRST_THRESHOLD, k / (THRESHOLDS - 1.)));
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

//! A pose, or the one with t the other way, which has the same epipolar lines.
Candidate candidateOf(
        const EpipolarProblem& problem, const RelativePose& pose, double scale, const Errors& weights)
{
    Candidate two[2];
    for (int k = 0; k < 2; k++)
    {
        two[k].pose = {pose.R, k ? -pose.t : pose.t};
        problem.squaredErrors(two[k].pose, two[k].squared);
        two[k].sum = misfit(two[k].squared, scale, weights);
    }
    return two[two[1].sum < two[0].sum];
}

//! The scale that the errors within a distance tell by their median.
double scaleWithin(const Errors& squared, double distance, int parameters)
{
    Errors near;
    for (double error : squared)
        if (error < square(distance))
            near.push_back(error);
    const double free = (double)near.size() - parameters, least = .1;
    if (free <= 0)
        return std::max(distance / 3, least);
    const auto middle = near.begin() + near.size() / 2;
    std::nth_element(near.begin(), middle, near.end());
    return std::max(1.4826 * std::sqrt(*middle * near.size() / free), least);
}

//! The best pose under a scale, and the other candidates.
PoseFit fitBy(const EpipolarProblem& problem, const Verdict& verdict, double scale, int trials,
        const Errors& weights)
{
    PoseFit fit;
    const Loss wide{1.2 * scale, 50};  // up to eight and a half scales
    std::vector<Candidate> candidates;
    const auto add = [&](const std::vector<RelativePose>& poses) {
        const size_t count = candidates.size();
        candidates.resize(count + poses.size());
        inParallel(poses.size(),
                [&](size_t i) { candidates[count + i] = candidateOf(problem, poses[i], scale, weights); });
        std::stable_sort(candidates.begin(), candidates.end());
    };
    const Search<EpipolarProblem> found = search(problem, Loss{scale}, Loss{2 * scale}, FEWEST, trials);
    fit.samples = found.samples;
    fit.wantsMore = found.wantsMore;
    add(found.models);
    if (found.samples >= MANY_TRIALS && !candidates.empty())
    {
        // Few of the samples were right. Of what agrees with the best pose so far, many are.
        std::vector<int> agree;
        for (int i = 0; i < problem.size(); i++)
            if (candidates[0].squared[i] < square(LAST_THRESHOLD * scale))
                agree.push_back(i);
        add(search(problem, wide, wide, FEWEST, FEWEST, agree).models);
    }
    std::vector<RelativePose> narrow;
    for (size_t i = 0; i < std::min<size_t>(candidates.size(), 3); i++)
        narrow.push_back(candidates[i].pose);
    inParallel(narrow.size(), [&](size_t i) { polish(problem, Loss{scale}, ROUGHLY, narrow[i]); });
    add(narrow);
    if (candidates.empty())
        return fit;
    fit.model = candidates[0].pose;
    fit.squared.swap(candidates[0].squared);
    for (size_t i = 1; i < candidates.size(); i++)
        fit.others.push_back(candidates[i].pose);
    std::vector<double> limits;
    for (double scales : {1.5, 3., 6., 12.})
        limits.push_back(scales * scale);
    const Errors wrong = errorsOfWrongMatches(problem, fit.model, verdict);
    fit.logFalseAlarms = verdict.logFalseAlarms(
            fit.squared, wrong, Verdict::FROM_LINE, problem.sampleSize(), limits, &fit.limit);
    fit.chance = verdict.chance(Verdict::FROM_LINE, fit.limit, wrong);
    return fit;
}

/** Polishes what may explain the matches as well: t the other way, the other poses of a plane, and the candidates that are apart from
the pose and from each other. */
void addOthers(const EpipolarProblem& problem, PoseFit& fit)
{
    const size_t most = 6;
    std::vector<RelativePose> all = problem.rivals(fit.model, fit.scale);
    all.insert(all.end(), fit.others.begin(), fit.others.end());
    fit.others = {{fit.model.R, -fit.model.t}};
    for (const RelativePose& pose : all)
    {
        const auto isApart = [&](const RelativePose& other) { return problem.areApart(pose, other); };
        if (fit.others.size() < most && isApart(fit.model) &&
                std::all_of(fit.others.begin(), fit.others.end(), isApart))
            fit.others.push_back(pose);
    }
    inParallel(
            fit.others.size(), [&](size_t i) { polish(problem, Loss{fit.scale}, ROUGHLY, fit.others[i]); });
}

}  // namespace

double widerScale(const EpipolarProblem& problem, const Errors& squared, double scale)
{
    for (double wider = scale, told; wider <= problem.mostScale(); wider *= 2)
        if (settles(squared, FARTHEST_OF_CHOICE * wider, problem.parameters(), told))
            return std::max(told, scale);
    return scale;
}

PoseFit fitPose(const EpipolarProblem& problem, const Verdict& verdict, double scale, const Errors& weights)
{
    PoseFit best;
    int samples = 0;
    const auto tryBy = [&](double unit, int trials) {
        PoseFit fit = fitBy(problem, verdict, unit, trials, weights);
        samples += fit.samples;
        fit.scale = scale > 0 ? scale : scaleWithin(fit.squared, fit.limit, problem.parameters());
        if (best.squared.empty() || fit.logFalseAlarms < best.logFalseAlarms)
            best = fit;
        return fit.wantsMore;
    };
    if (scale > 0)
        tryBy(scale, MOST_TRIALS);
    else
    {
        const auto isCertain = [&] { return best.logFalseAlarms < Verdict::CERTAIN; };
        const bool wantsMore = tryBy(REFINED, FEW_TRIALS);
        bool isWide = isCertain() && best.scale > MOST_OF_REFINED;
        if (wantsMore && !isWide)
        {
            best = PoseFit();
            tryBy(REFINED, MOST_TRIALS);
        }
        for (double unit = WIDER * REFINED; (isWide || !isCertain()) && unit <= problem.mostScale();
                unit *= WIDER)
        {
            tryBy(unit, FEW_TRIALS);
            isWide = false;
        }
    }
    const auto agreeing = [](const PoseFit& fit) {
        const Verdict::Marks near = within(fit.limit, fit.squared);
        return std::count(near.begin(), near.end(), true);
    };
    if (scale == 0 && problem.size() < FEW)
    {
        // A pose may be fitted to some of few matches so well that the others seem wrong.
        const PoseFit narrow = best;
        best = PoseFit();
        tryBy(WIDER * REFINED, FEW_TRIALS);
        if (best.logFalseAlarms > Verdict::CERTAIN || agreeing(best) < agreeing(narrow))
            best = narrow;
    }
    best.samples = samples;
    if (best.squared.empty())
        return best;
    if (scale == 0)
        best.scale = widerScale(problem, best.squared, best.scale);
    polish(problem, Loss{best.scale}, FINELY, best.model);
    finish(problem, best);
    addOthers(problem, best);
    double least = misfit(best.squared, best.scale, weights);
    for (RelativePose& other :
            best.others)  // of a pose that was polished finely, the better one may be next to it
    {
        const Candidate candidate = candidateOf(problem, other, best.scale, weights);
        if (candidate.sum >= least)
            continue;
        least = candidate.sum;
        other = best.model;
        best.model = candidate.pose;
    }
    finish(problem, best);
    return best;
}

}  // namespace cv::iib
