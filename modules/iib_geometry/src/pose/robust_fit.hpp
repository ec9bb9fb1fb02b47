// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "../common/parallel.hpp"
#include "opencv2/core.hpp"

namespace cv::iib {

/* Fits a model to matches many of which are wrong. A class Problem holds the matches and has
    Model, Step     what is sought, and a Vec<double, N> of changes to it
    int size()      number of matches
    int parameters()                   degrees of freedom of a model, N at most
    propose(sample, models)            models that agree with a sample: indices of SampleSize matches
    double loss(model, Loss, limit)    the sum over all matches, or anything over the limit
    squaredErrors(model, errors)       of all matches, pixels^2; infinite where the model forbids the match
    linearize(model, limit, rows)      the rows of matches whose squared error is below the limit
    Model moved(model, step) */

const double FARTHEST = 9;            // three scales
const double FARTHEST_OF_CHOICE = 4;  // scales at which squared errors are cut off when a model is chosen

/** Of a match with squared error r^2, Cauchy's log(1 + r^2 / scale^2), and from `farthest` scales^2 on that of `farthest`: by how far a
wrong match is wrong says nothing. */
struct Loss
{
    double scale;  //!< pixels
    double farthest = FARTHEST;
};

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
void polish(const Problem& problem, const Loss& by, double enough, typename Problem::Model& model)
{
    typedef typename Problem::Step Step;
    const int rounds = 50;
    const double most = 1e6;       // of the damping
    const double nothing = 1e-12;  // of a loss: exact matches have no end else
    const double least = 1e-12;    // on the diagonal, where the rows do not tell a number at all
    const double perScale2 = 1 / square(by.scale);
    double damping = 1e-3, loss = problem.loss(model, by, std::numeric_limits<double>::max());
    std::vector<Row<Step>> rows;
    for (int round = 0; round < rounds && loss > nothing; round++)
    {
        problem.linearize(model, by.farthest * square(by.scale), rows);
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
            const double loss2 = problem.loss(next, by, loss);
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
    double scale = 0;             //!< under which the model was polished, pixels
    std::vector<double> squared;  //!< errors of the matches, pixels^2; of none if there is no model
    int samples = 0;              //!< that were tried
    double inlierRatio = 0;       //!< share of the matches within three scales
};

//! Models that samples led to, polished roughly, and how they were found.
template <class Problem> struct Search
{
    std::vector<typename Problem::Model>
            models;  //!< those of the least loss, the least one first as samples proposed them
    int samples = 0;
    bool wantsMore = false;  //!< whether more samples might find a better one
};

/** Looks for models that many matches agree with. The same in every run.

Samples propose models, and those of the least loss are kept. Each is polished under a wider loss in the end: at a narrow scale a model
that a cluster of wrong matches has drawn to itself may win.
@param fewest samples that are tried, however many matches agree.
@param pool matches that samples are taken from; empty: all. */
template <class Problem>
Search<Problem> search(const Problem& problem, const Loss& by, const Loss& wider, int fewest, int mostTrials,
        const std::vector<int>& pool = {})
{
    typedef typename Problem::Model Model;
    const double roughly = 1e-3;  // how much less of its loss a model is polished for
    const size_t most = 10;  // are polished in the end: that of the least loss need not lead to the best one
    const size_t expected = 2;   // are polished before: by the better one samples are expected
    const double missed = 1e-4;  // probability that no sample was of right matches alone
    const double none = std::numeric_limits<double>::max();
    Search<Problem> found;
    const int count = problem.size(), size = problem.sampleSize();
    if (count < size || (!pool.empty() && (int)pool.size() < size))
        return found;

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
        polish(problem, by, roughly, model);
        const double loss = problem.loss(model, by, leastLoss);
        if (loss >= leastLoss)
            return;
        leastLoss = loss;
        problem.squaredErrors(model, squared);
        const double inside = FARTHEST * square(by.scale);
        const auto near = std::count_if(squared.begin(), squared.end(), [&](double e) { return e < inside; });
        // Fischler and Bolles (1981): samples until one in 1 / missed searches had none of right matches alone.
        const double right = std::pow((double)near / count, size);  // probability of such a sample
        const double wanted = right > 0 ? std::log(missed) / std::log1p(-std::min(right, .999)) : none;
        trials = std::max<double>(fewest, std::min<double>(mostTrials, wanted));
    };
    const auto limitOf = [&] { return best.size() < most ? none : best.back().first; };
    while (found.samples < trials)
    {
        proposals.resize(cvCeil(std::min(batch, trials - found.samples)));
        for (Proposal& proposal : proposals)
        {
            std::vector<int>& sample = proposal.sample;
            sample.resize(size);
            for (int k = 0; k < size; k++)
                do
                    sample[k] = pool.empty() ? random.uniform(0, count)
                                             : pool[random.uniform(0, (int)pool.size())];
                while (std::find(sample.begin(), sample.begin() + k, sample[k]) != sample.begin() + k);
        }
        const double limit = limitOf();
        inParallel(proposals.size(), [&](size_t i) {
            Proposal& proposal = proposals[i];
            problem.propose(proposal.sample, proposal.models);
            proposal.losses.clear();
            for (const Model& model : proposal.models)
                proposal.losses.push_back(problem.loss(model, by, limit));
        });
        for (size_t i = 0; i < proposals.size() && found.samples < trials; i++)
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
            if (++found.samples >= fewest && better)
            {
                for (size_t k = 0; k < std::min(best.size(), expected); k++)
                    expect(best[k].second);
                better = false;
            }
        }
    }

    found.wantsMore = trials == mostTrials;
    found.models.resize(best.size());
    inParallel(best.size(), [&](size_t i) {
        found.models[i] = best[i].second;
        polish(problem, wider, roughly, found.models[i]);
    });
    return found;
}

//! Takes the errors of a fit's model, and how many of the matches are near.
template <class Problem> void finish(const Problem& problem, Fit<Problem>& fit)
{
    problem.squaredErrors(fit.model, fit.squared);
    const double near = FARTHEST * square(fit.scale);
    const auto count =
            std::count_if(fit.squared.begin(), fit.squared.end(), [&](double e) { return e < near; });
    fit.inlierRatio = (double)count / std::max(problem.size(), 1);
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
    the one before, with few samples, until the errors settle.
@param mostScale by which models are looked for, pixels. */
template <class Problem> Fit<Problem> robustFit(const Problem& problem, double scale, double mostScale = .5)
{
    const double finely = 1e-9, refined = .25;
    const int fewest = 150, fewTrials = 1000, mostTrials = 10000;
    Fit<Problem> fit;
    bool wantsMore = false;
    const auto searchBy = [&](double narrow, int trials) {
        const Search<Problem> found = search(problem, Loss{narrow}, Loss{2 * narrow}, fewest, trials);
        fit.samples += found.samples;
        fit.squared.clear();
        wantsMore = found.wantsMore;
        double least = std::numeric_limits<double>::infinity();
        std::vector<double> squared;
        for (const typename Problem::Model& model : found.models)
        {
            double sum = 0;
            problem.squaredErrors(model, squared);
            for (double error : squared)
                sum += std::min(error, square(FARTHEST_OF_CHOICE * narrow));
            if (sum >= least)
                continue;
            least = sum;
            fit.model = model;
            fit.squared.swap(squared);
        }
    };
    double narrow = scale > 0 ? scale : refined, told = scale;
    bool settled = scale > 0;
    for (; !settled && narrow <= mostScale; narrow *= settled ? 1 : 2)
    {
        searchBy(narrow, fewTrials);
        settled = settles(fit.squared, FARTHEST_OF_CHOICE * narrow, problem.parameters(), told);
    }
    if (!settled)
        narrow = 2 * refined;
    if (wantsMore || fit.squared.empty() || !settled)
        searchBy(narrow, mostTrials);
    if (fit.squared.empty())
        return fit;
    if (scale == 0 && !settles(fit.squared, FARTHEST_OF_CHOICE * narrow, problem.parameters(), told))
        told = narrow;
    fit.scale = told;
    polish(problem, Loss{told}, finely, fit.model);
    finish(problem, fit);
    return fit;
}

}  // namespace cv::iib
