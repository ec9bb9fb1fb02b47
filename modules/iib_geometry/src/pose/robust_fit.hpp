// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "../common/parallel.hpp"
#include "opencv2/core.hpp"

namespace cv::iib {

/* Fits a model to matches many of which are wrong. The loss of a match with squared error r^2 is Cauchy's log(1 + r^2 / scale^2),
and from FARTHEST scales^2 on that of FARTHEST: by how far a wrong match is wrong says nothing.

A class Problem holds the matches and has
    Model, Step     what is sought, and a Vec<double, N> of changes to it
    int size()      number of matches
    double mostScale()                 by which models are looked for, pixels
    int sampleSize(), parameters()     matches that give a model; its degrees of freedom, N at most
    int fewestSamples()                that are tried, however many matches agree
    propose(sample, models)            models that agree with a sample: indices of sampleSize() matches
    double loss(model, scale, limit)   the sum over all matches, or anything over the limit
    squaredErrors(model, errors)       of all matches, pixels^2; infinite where the model forbids the match
    alternatives(model)                models of the same loss that other squared errors may belong to
    rivals(model, scale)               models, roughly, that may explain the same matches by another answer
    bool areApart(model, other)        whether they are other answers, and not the same one found twice
    linearize(model, limit, rows)      the rows of matches whose squared error is below the limit
    Model moved(model, step) */

const double FARTHEST = 9;            // three scales
const double FARTHEST_OF_CHOICE = 4;  // scales at which squared errors are cut off when a model is chosen

//! One coordinate of a match's error in pixels, its derivatives, and the squared length of the whole error.
template <class Step> struct Row
{
    int match;
    double r;
    Step J;
    double r2;
};

template <class Step> using Square = Matx<double, Step::channels, Step::channels>;

inline double square(double x) { return x * x; }

//! Adds weight J J' to the lower triangle of a sum.
template <class Step> void addProduct(const Step& J, double weight, Square<Step>& sum)
{
    for (int a = 0; a < Step::channels; a++)
        for (int b = 0; b <= a; b++)
            sum(a, b) += weight * J[a] * J[b];
}

//! Copies the lower triangle of a matrix to the upper one.
template <int N> void mirror(Matx<double, N, N>& m)
{
    for (int a = 0; a < N; a++)
        for (int b = a + 1; b < N; b++)
            m(a, b) = m(b, a);
}

/** Lowers the loss by Levenberg and Marquardt's steps, until one lowers it by less than `enough` of it: with H the sum of w J J',
w = 1 / (scale^2 + r^2), (H + damping diag H) step = -(sum of w r J) (Hartley and Zisserman 2004, appendix 6.2). */
template <class Problem>
void polish(const Problem& problem, double scale, double enough, typename Problem::Model& model)
{
    typedef typename Problem::Step Step;
    const int rounds = 50;
    const double most = 1e6;     // of the damping
    const double least = 1e-12;  // on the diagonal, where the rows do not tell a number at all
    const double perScale2 = 1 / (scale * scale);
    double damping = 1e-3, loss = problem.loss(model, scale, std::numeric_limits<double>::max());
    std::vector<Row<Step>> rows;
    for (int round = 0; round < rounds; round++)
    {
        problem.linearize(model, FARTHEST * scale * scale, rows);
        Square<Step> hessian = Square<Step>::eye() * least;
        Step gradient, step;
        for (const Row<Step>& row : rows)
        {
            const double weight = perScale2 / (1 + row.r2 * perScale2);
            addProduct(row.J, weight, hessian);
            gradient += weight * row.r * row.J;
        }
        mirror(hessian);
        const double before = loss;
        for (bool lower = false; !lower; damping *= lower ? .1 : 10)
        {
            if (damping > most)
                return;
            Square<Step> damped = hessian;
            for (int k = 0; k < Step::channels; k++)
                damped(k, k) *= 1 + damping;
            solve(damped, gradient, step, DECOMP_CHOLESKY);
            const typename Problem::Model next = problem.moved(model, -step);
            const double loss2 = problem.loss(next, scale, loss);
            lower = loss2 < loss;
            if (lower)
            {
                model = next;
                loss = loss2;
            }
        }
        if (before - loss < enough * before)
            return;
    }
}

//! What robustFit finds.
template <class Problem> struct Fit
{
    typename Problem::Model model;
    double scale = 0;                  //!< under which the model was polished, pixels
    std::vector<double> squared;       //!< errors of the matches, pixels^2; of none if there is no model
    typename Problem::Model other;     //!< the next best one that is apart from it
    std::vector<double> otherSquared;  //!< its errors; of none if there is no other
    bool wantsMore = false;            //!< whether more samples might find a better one
};

//! A model by its sum of squared errors, cut off at four scales: by how far a wrong match is wrong says nothing.
template <class Problem> struct Candidate
{
    typename Problem::Model model;
    std::vector<double> squared;
    double sum;

    bool operator<(const Candidate& other) const { return sum < other.sum; }
};

//! A model and its alternatives, the best one first.
template <class Problem>
std::vector<Candidate<Problem>> withAlternatives(
        const Problem& problem, double scale, const typename Problem::Model& model)
{
    std::vector<typename Problem::Model> models = problem.alternatives(model);
    models.insert(models.begin(), model);
    std::vector<Candidate<Problem>> candidates(models.size());
    for (size_t k = 0; k < models.size(); k++)
    {
        Candidate<Problem>& candidate = candidates[k];
        candidate.model = models[k];
        candidate.sum = 0;
        problem.squaredErrors(models[k], candidate.squared);
        for (double error : candidate.squared)
            candidate.sum += std::min(error, square(FARTHEST_OF_CHOICE * scale));
    }
    std::stable_sort(candidates.begin(), candidates.end());
    return candidates;
}

//! Takes the best candidate and the next best one apart from it, if there are any.
template <class Problem>
void take(const Problem& problem, std::vector<Candidate<Problem>>& candidates, Fit<Problem>& fit)
{
    std::stable_sort(candidates.begin(), candidates.end());
    fit.squared.clear();
    fit.otherSquared.clear();
    for (Candidate<Problem>& candidate : candidates)
        if (fit.squared.empty())
        {
            fit.model = candidate.model;
            fit.squared.swap(candidate.squared);
        }
        else if (problem.areApart(candidate.model, fit.model))
        {
            fit.other = candidate.model;
            fit.otherSquared.swap(candidate.squared);
            return;
        }
}

/** The model that most matches agree with under one scale, pixels, not polished finely. The same in every run.

Samples propose models, and those of the least loss are kept. Each is polished under twice the scale, and the one with the least
sum of squared errors, cut off at four scales, is chosen: at the narrow scale a model that a cluster of wrong matches has drawn to
itself may win. */
template <class Problem> Fit<Problem> search(const Problem& problem, double scale, int mostTrials)
{
    typedef typename Problem::Model Model;
    const double roughly = 1e-3;  // how much less of its loss a model is polished for
    const size_t most = 10;  // are polished in the end: that of the least loss need not lead to the best one
    const size_t expected = 2;   // are polished before: by the better one samples are expected
    const double missed = 1e-4;  // probability that no sample was of right matches alone
    const double none = std::numeric_limits<double>::max();
    Fit<Problem> fit;
    const int count = problem.size(), size = problem.sampleSize();
    if (count < size)
        return fit;

    RNG random(0x5eed);
    struct Proposal
    {
        std::vector<int> sample;
        std::vector<Model> models;
        std::vector<double> losses;  // or anything over the limit
    };
    // Several threads propose at once; models are taken in the order of their samples, by the limit that is then. The fewest
    // samples, 100 or 150, are whole batches.
    const double batch = getNumThreads() > 1 ? 25 : 1;
    std::vector<Proposal> proposals;
    std::vector<std::pair<double, Model>> best;  // losses in order, and models
    std::vector<double> squared;
    double leastLoss = none, trials = mostTrials;
    bool better = false;  // whether there is a better one than when samples were last expected
    const auto expect = [&](Model model) {
        polish(problem, scale, roughly, model);
        const double loss = problem.loss(model, scale, leastLoss);
        if (loss >= leastLoss)
            return;
        leastLoss = loss;
        problem.squaredErrors(model, squared);
        const double inside = FARTHEST * scale * scale;
        const auto near = std::count_if(squared.begin(), squared.end(), [&](double e) { return e < inside; });
        // Fischler and Bolles (1981): samples until one in 1 / missed searches had none of right matches alone.
        const double right = std::pow((double)near / count, size);  // probability of such a sample
        const double wanted = right > 0 ? std::log(missed) / std::log1p(-std::min(right, .999)) : none;
        trials = std::max<double>(problem.fewestSamples(), std::min<double>(mostTrials, wanted));
    };
    const auto limitOf = [&] { return best.size() < most ? none : best.back().first; };
    for (int trial = 0; trial < trials;)
    {
        proposals.resize(cvCeil(std::min(batch, trials - trial)));
        for (Proposal& proposal : proposals)
        {
            std::vector<int>& sample = proposal.sample;
            sample.resize(size);
            for (int k = 0; k < size; k++)
                do
                    sample[k] = random.uniform(0, count);
                while (std::find(sample.begin(), sample.begin() + k, sample[k]) != sample.begin() + k);
        }
        const double limit = limitOf();
        inParallel(proposals.size(), [&](size_t i) {
            Proposal& proposal = proposals[i];
            problem.propose(proposal.sample, proposal.models);
            proposal.losses.clear();
            for (const Model& model : proposal.models)
                proposal.losses.push_back(problem.loss(model, scale, limit));
        });
        for (size_t i = 0; i < proposals.size() && trial < trials; i++)
        {
            for (size_t k = 0; k < proposals[i].models.size(); k++)
            {
                const std::pair<double, Model> one(proposals[i].losses[k], proposals[i].models[k]);
                if (one.first >= limitOf())
                    continue;
                if (best.size() == most)
                    best.pop_back();
                auto place = best.begin();
                while (place != best.end() && place->first <= one.first)
                    ++place;
                better |= best.insert(place, one) == best.begin();
            }
            if (++trial >= problem.fewestSamples() && better)
            {
                for (size_t k = 0; k < std::min(best.size(), expected); k++)
                    expect(best[k].second);
                better = false;
            }
        }
    }

    fit.wantsMore = trials == mostTrials;
    std::vector<Candidate<Problem>> candidates(best.size());
    inParallel(best.size(), [&](size_t i) {
        polish(problem, 2 * scale, roughly, best[i].second);
        candidates[i] = withAlternatives(problem, scale, best[i].second).front();
    });
    take(problem, candidates, fit);
    return fit;
}

/** Whether the errors within a distance are those of right matches: most of them far below it, and few others around it. Else matches
err by more, or are wrong.
@param parameters of the model: so many errors are small because it was fitted to them.
@param scale that the errors within it tell, by their median (Rousseeuw and Leroy 1987). */
inline bool settles(const std::vector<double>& squared, double distance, int parameters, double& scale)
{
    const double most = .3;                  // of the distance: the median error
    const double wider = 4, mostMore = 1.5;  // of those within the distance are within so many of it
    const double least = .1;                 // scale, pixels: of refined matches
    std::vector<double> near;
    double around = 0;
    for (double error : squared)
    {
        if (error < square(distance))
            near.push_back(error);
        around += error < square(wider * distance);
    }
    const double free = (double)near.size() - parameters;
    if (free <= 0)
        return false;
    const auto middle = near.begin() + near.size() / 2;
    std::nth_element(near.begin(), middle, near.end());
    const double median = std::sqrt(*middle * near.size() / free);
    scale = std::max(1.4826 * median, least);
    return median < most * distance && around - parameters < mostMore * free;
}

/** The model that most matches agree with. The same in every run.
@param scale of Cauchy's loss, pixels; 0: the errors tell it. Then scales from that of refined matches upwards are tried, each twice
    the one before, with few samples, until the errors settle. */
template <class Problem> Fit<Problem> robustFit(const Problem& problem, double scale)
{
    const double finely = 1e-9, roughly = 1e-4, refined = .25;
    const int fewTrials = 1000, mostTrials = 10000;
    Fit<Problem> fit;
    double narrow = scale > 0 ? scale : refined, told = scale;
    bool settled = scale > 0;
    for (; !settled && narrow <= problem.mostScale(); narrow *= settled ? 1 : 2)
    {
        fit = search(problem, narrow, fewTrials);
        settled = settles(fit.squared, FARTHEST_OF_CHOICE * narrow, problem.parameters(), told);
    }
    if (!settled)
        narrow = 2 * refined;
    if (fit.wantsMore || fit.squared.empty() || !settled)
        fit = search(problem, narrow, mostTrials);
    if (fit.squared.empty())
        return fit;
    if (scale == 0 && !settles(fit.squared, FARTHEST_OF_CHOICE * narrow, problem.parameters(), told))
        told = narrow;
    fit.scale = told;
    polish(problem, fit.scale, finely, fit.model);
    std::vector<Candidate<Problem>> candidates = withAlternatives(problem, fit.scale, fit.model);
    std::vector<typename Problem::Model> rivals = problem.rivals(fit.model, fit.scale);
    if (!fit.otherSquared.empty())
        rivals.push_back(fit.other);
    const size_t own = candidates.size();
    candidates.resize(own + rivals.size());
    inParallel(rivals.size(), [&](size_t i) {
        polish(problem, fit.scale, roughly, rivals[i]);
        candidates[own + i] = withAlternatives(problem, fit.scale, rivals[i]).front();
    });
    take(problem, candidates, fit);
    return fit;
}

}  // namespace cv::iib
