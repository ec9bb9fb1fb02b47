// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "opencv2/core.hpp"

namespace cv::iib {

/* Fits a model to matches many of which are wrong. Errors are divided by a scale; the loss of a match with squared error
r^2 is Cauchy's log(1 + r^2), and from FARTHEST on that of FARTHEST: by how far a wrong match is wrong says nothing.

A class Problem holds the matches and has
    Model, Step     what is sought, and a Vec<double, N> of changes to it
    int size()      number of matches
    int sampleSize(), parameters()     matches that give a model; its degrees of freedom, N at most
    propose(sample, models)            models that agree with a sample: indices of sampleSize() matches
    double loss(model, limit)          the sum over all matches, or anything over the limit
    double verdict(model)              the loss that chooses among models; matches that a model forbids count as FARTHEST
    linearize(model, rows)             the rows of matches below FARTHEST
    Model moved(model, step)
    int inliers(model, mask)           marks and counts the matches below FARTHEST that the model allows */

const double FARTHEST = 9;  // three scales

//! One coordinate of a match's error, its derivatives, and the squared length of the whole error.
template <class Step> struct Row
{
    double r;
    Step J;
    double r2;
};

template <class Step> using Square = Matx<double, Step::channels, Step::channels>;

//! The sum of weight(row) J J' over the rows, with a little on the diagonal where they do not tell a number at all.
template <class Step, class Weight>
Square<Step> normalMatrix(const std::vector<Row<Step>>& rows, Weight weight)
{
    const int N = Step::channels;
    Square<Step> sum = Square<Step>::zeros();
    for (const Row<Step>& row : rows)
    {
        const double w = weight(row);
        for (int a = 0; a < N; a++)
            for (int b = 0; b <= a; b++)
                sum(a, b) += w * row.J[a] * row.J[b];
    }
    for (int a = 0; a < N; a++)
    {
        sum(a, a) += 1e-12;
        for (int b = a + 1; b < N; b++)
            sum(a, b) = sum(b, a);
    }
    return sum;
}

//! Lowers the loss by Levenberg and Marquardt's steps, at most `rounds`.
template <class Problem> void polish(const Problem& problem, typename Problem::Model& model, int rounds)
{
    typedef typename Problem::Step Step;
    const double most = 1e6, enough = 1e-9;  // of the damping; relative decrease at which it has converged
    double damping = 1e-3, loss = problem.loss(model, std::numeric_limits<double>::max());
    std::vector<Row<Step>> rows;
    for (int round = 0; round < rounds; round++)
    {
        problem.linearize(model, rows);
        const auto weight = [](const Row<Step>& row) { return 1 / (1 + row.r2); };
        const Square<Step> hessian = normalMatrix(rows, weight);
        Step gradient, step;
        for (const Row<Step>& row : rows)
            gradient += weight(row) * row.r * row.J;
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
            const double loss2 = problem.loss(next, loss);
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

//! Covariance of the numbers of a step at a minimum of the loss: that of an M-estimator (Huber 1981, equation 7.6.2).
template <class Problem>
Square<typename Problem::Step> covarianceOf(const Problem& problem, const typename Problem::Model& model)
{
    typedef typename Problem::Step Step;
    const double leastSlope = .05;  // of psi on average: the noise is far over the scale
    std::vector<Row<Step>> rows;
    problem.linearize(model, rows);
    double influence2 = 0, slope = 0;  // of psi = r / (1 + r^2)
    for (const Row<Step>& row : rows)
    {
        const double weight = 1 / (1 + row.r2), psi = weight * row.r;
        influence2 += psi * psi;
        slope += weight - 2 * psi * psi;
    }
    const double count = (double)rows.size(), meanSlope = std::max(slope / count, leastSlope);
    const double variance = influence2 / std::max(count - problem.parameters(), 1.) / (meanSlope * meanSlope);
    return normalMatrix(rows, [](const Row<Step>&) { return 1; }).inv(DECOMP_CHOLESKY) * variance;
}

/** The model of the least loss that samples lead to. The same in every run.
@param inliers of it; all 0 if there is none
@returns false if no model agrees with as many matches as a sample has */
template <class Problem>
bool robustFit(const Problem& problem, typename Problem::Model& best, std::vector<uchar>& inliers)
{
    typedef typename Problem::Model Model;
    const int fewestTrials = 300, mostTrials = 10000, shortPolish = 10, longPolish = 50;
    const size_t most =
            10;  // models polished in the end: that of the least loss need not lead to the best one
    const double missed = 1e-4;  // probability that no sample was of right matches alone
    const double none = std::numeric_limits<double>::max();
    const int count = problem.size(), size = problem.sampleSize();
    inliers.assign(count, 0);
    if (count < size)
        return false;
    RNG random(0x5eed);
    std::vector<int> sample(size);
    std::vector<Model> models;
    std::vector<std::pair<double, Model>> least;  // losses in order, and models
    double leastVerdict = none, trials = mostTrials;
    const auto judge = [&](Model model) {
        polish(problem, model, shortPolish);
        const double verdict = problem.verdict(model);
        if (verdict >= leastVerdict)
            return;
        leastVerdict = verdict;
        best = model;
        const double share = (double)problem.inliers(model, inliers) / count;
        const double miss = 1 - std::pow(share, size);
        const double wanted = share == 0 ? none : miss > 0 ? std::log(missed) / std::log(miss) : 0;
        trials = std::max<double>(fewestTrials, std::min<double>(mostTrials, wanted));
    };
    for (int trial = 0; trial < trials; trial++)
    {
        for (int k = 0; k < size; k++)
            do
                sample[k] = random.uniform(0, count);
            while (std::find(sample.begin(), sample.begin() + k, sample[k]) != sample.begin() + k);
        problem.propose(sample, models);
        for (const Model& model : models)
        {
            const double limit = least.size() < most ? none : least.back().first,
                         loss = problem.loss(model, limit);
            if (loss >= limit)
                continue;
            if (least.size() == most)
                least.pop_back();
            auto place = least.begin();
            while (place != least.end() && place->first <= loss)
                ++place;
            if (least.insert(place, {loss, model}) == least.begin())
                judge(model);
        }
    }
    for (size_t i = 1; i < least.size(); i++)
        judge(least[i].second);
    if (leastVerdict < none)
    {
        polish(problem, best, longPolish);
        if (problem.inliers(best, inliers) >= size)
            return true;
    }
    inliers.assign(count, 0);
    return false;
}

}  // namespace cv::iib
