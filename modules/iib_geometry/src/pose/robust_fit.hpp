// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <limits>

#include "../common/parallel.hpp"
#include "../common/points.hpp"

namespace cv::iib {

/* Fits a model to matches of which many are wrong. A class Problem holds the matches and has
    Model, Step                        the fitted model, and a Vec<double, N> of changes to it
    int size()                         number of matches
    int sampleSize()                   number of matches that determine a model
    int parameters()                   degrees of freedom of a model, N at most
    propose(sample, models)            models that agree with a sample: indices of sampleSize() matches
    double loss(model, Loss, limit)    the sum over all matches; any larger number if it exceeds the limit
    squaredErrors(model, errors)       of all matches, pixels^2; infinite where the model cannot explain the match
    linearize(model, limit, rows)      the rows of matches whose squared error is below the limit
    Model moved(model, step) */

const double REFINED = .25;           // pixels: least scale of the inlier threshold, that of refined matches
const double MISSED = 1e-4;           // accepted probability that every sample has a wrong match
const double FARTHEST = 9;            // squared scales
const double FARTHEST_OF_CHOICE = 4;  // scales at which squared errors are cut off when a model is chosen
const int MANY_SAMPLES = 10000;
const double FINELY = 1e-9, ROUGHLY = 1e-3;  // polish's `enough`

/** The loss of a squared error r^2: Cauchy's log(1 + r^2 / scale^2), constant from `farthest` scale^2 on. How far a wrong match is
off carries no information. */
struct Loss
{
    double scale;  //!< pixels
    double farthest = FARTHEST;
};

//! One coordinate of a match's error, pixels: r, its derivatives J, and the squared length r2 of the whole error.
template <class Step> struct Row
{
    int match;
    double r;
    Step J;
    double r2;
};

template <class Step> using Square = Matx<double, Step::channels, Step::channels>;

/** Adds weight J J' to the lower triangle of a sum, which completeSymm(sum, true) mirrors. GCC 12 compiles a mirroring loop of 8 rows
wrongly at -O1 and -O2. Entries beside the diagonal, which it replaces, make pairs that compilers vectorize. */
template <class Step> void addProduct(const Step& J, double weight, Square<Step>& sum)
{
    for (int a = 0; a < Step::channels; a++)
        if (Step::channels < 8 || J[a] != 0)  // a transform's J has many zeros
            for (int b = 0; b <= std::min(a | 1, Step::channels - 1); b++)
                sum(a, b) += weight * J[a] * J[b];
}

/** Minimizes the loss by Levenberg and Marquardt's method (Hartley and Zisserman 2004, appendix 6.2). A step solves
(H + damping diag H) step = -(sum of w r J), with H the sum of w J J' and w = 1 / (scale^2 + r^2).
@param enough ends the search: the relative decrease of the loss by one step. */
template <class Problem>
void polish(const Problem& problem, const Loss& by, double enough, typename Problem::Model& model)
{
    typedef typename Problem::Step Step;
    const int rounds = 50;
    const double most = 1e6;       // damping
    const double nothing = 1e-12;  // loss: the relative decrease never ends the search for exact matches
    const double least = 1e-12;    // on the diagonal, for parameters that the rows do not determine
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
        completeSymm(hessian, true);
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

//! The result of robustFit.
template <class Problem> struct Fit
{
    typename Problem::Model model;
    double scale = 0;             //!< of the loss that the model was polished under, pixels
    std::vector<double> squared;  //!< errors of the matches, pixels^2; empty if there is no model
    int samples = 0;              //!< number of samples that were tried
};

/** Searches for models that many matches agree with. Deterministic. Samples propose models, and the models of least loss are kept. At the
end each of them is polished under a wider loss: under a narrow one, a few wrong matches that agree may attract a model. */
template <class Problem> class Search
{
public:
    typedef typename Problem::Model Model;

    /** @param fewest least number of samples.
    @param pool matches to sample from; empty: all.
    @param likely matches for every second sample. */
    Search(const Problem& problem, const Loss& by, const Loss& wider, int fewest,
            const std::vector<int>& pool = {}, const std::vector<int>& likely = {})
        : problem_(problem), by_(by), wider_(wider), fewest_(fewest), pools_{pool}, random_(0x5eed)
    {
        if (pool.empty())
            for (int i = 0; i < problem.size(); i++)
                pools_[0].push_back(i);
        if ((int)likely.size() >= 2 * problem.sampleSize())
            pools_.push_back(likely);
    }

    /** Continues until `mostTrials` samples were tried, or enough for the share of matches that agree.
    @return the models of least loss, polished roughly, in the order of their losses before that. */
    std::vector<Model> upTo(int mostTrials)
    {
        if ((int)pools_[0].size() >= problem_.sampleSize())
            while (samples_ < std::min<double>(mostTrials, wanted_))
                trySamples(mostTrials);
        std::vector<Model> models(best_.size());
        inParallel(best_.size(), [&](size_t i) {
            models[i] = best_[i].second;
            polish(problem_, wider_, ROUGHLY, models[i]);
        });
        return models;
    }

    int samples() const { return samples_; }
    bool wantsMore() const { return samples_ < wanted_; }  //!< whether more samples might find a better model

private:
    static constexpr size_t MOST = 10;  // models kept: the one of least loss need not lead to the best result
    struct Proposal
    {
        std::vector<int> sample;
        std::vector<Model> models;
        std::vector<double> losses;  // any larger number over the limit
    };

    double limit() const
    {
        return best_.size() < MOST ? std::numeric_limits<double>::max() : best_.back().first;
    }

    //! Tries a batch of samples in parallel, and keeps their models in the samples' order: threads do not change the result.
    void trySamples(int mostTrials)
    {
        const double batch = getNumThreads() > 1 ? 25 : 1;  // divides `fewest`, 100 or 150
        const size_t expected = 2;  // best models that may be right; each gives a wanted number of samples
        proposals_.resize(cvCeil(std::min({batch, (double)mostTrials - samples_, wanted_ - samples_})));
        for (size_t i = 0; i < proposals_.size(); i++)
        {
            const std::vector<int>& pool = pools_[(samples_ + i) % pools_.size()];
            std::vector<int>& sample = proposals_[i].sample;
            sample.resize(problem_.sampleSize());
            for (size_t k = 0; k < sample.size(); k++)
                do
                    sample[k] = pool[random_.uniform(0, (int)pool.size())];
                while (std::find(sample.begin(), sample.begin() + k, sample[k]) != sample.begin() + k);
        }
        const double before = limit();
        inParallel(proposals_.size(), [&](size_t i) {
            Proposal& proposal = proposals_[i];
            problem_.propose(proposal.sample, proposal.models);
            proposal.losses.clear();
            for (const Model& model : proposal.models)
                proposal.losses.push_back(problem_.loss(model, by_, before));
        });
        for (size_t i = 0; i < proposals_.size() && samples_ < wanted_; i++)
        {
            for (size_t k = 0; k < proposals_[i].models.size(); k++)
                keep({proposals_[i].losses[k], proposals_[i].models[k]});
            if (++samples_ >= fewest_ && better_)
            {
                for (size_t k = 0; k < std::min(best_.size(), expected); k++)
                    expect(best_[k].second);
                better_ = false;
            }
        }
    }

    void keep(const std::pair<double, Model>& one)
    {
        if (one.first >= limit())
            return;
        if (best_.size() == MOST)
            best_.pop_back();
        auto place = best_.begin();
        while (place != best_.end() && place->first <= one.first)
            ++place;
        better_ |= best_.insert(place, one) == best_.begin();
    }

    //! Updates the wanted number of samples, assuming that a model is right.
    void expect(Model model)
    {
        polish(problem_, by_, ROUGHLY, model);
        const double loss = problem_.loss(model, by_, leastLoss_);
        if (loss >= leastLoss_)
            return;
        leastLoss_ = loss;
        std::vector<double> squared;
        problem_.squaredErrors(model, squared);
        const double inside = FARTHEST * square(by_.scale);
        // Fischler and Bolles (1981): log(MISSED) / log(1 - share of samples without a wrong match)
        double right = 0;
        for (const std::vector<int>& pool : pools_)
        {
            const auto near =
                    std::count_if(pool.begin(), pool.end(), [&](int i) { return squared[i] < inside; });
            right += std::pow((double)near / pool.size(), problem_.sampleSize()) / pools_.size();
        }
        wanted_ = right > 0 ? std::log(MISSED) / std::log1p(-std::min(right, .999))
                            : std::numeric_limits<double>::max();
        wanted_ = std::max<double>(fewest_, wanted_);
    }

    const Problem& problem_;
    const Loss by_, wider_;
    const int fewest_;
    std::vector<std::vector<int>> pools_;
    RNG random_;
    std::vector<Proposal> proposals_;
    std::vector<std::pair<double, Model>> best_;  // losses, ascending, and their models
    double leastLoss_ = std::numeric_limits<double>::max(), wanted_ = leastLoss_;
    bool better_ = false;  // whether the best model changed since wanted_ was updated
    int samples_ = 0;
};

/** The scale, in pixels, of the errors below a distance, from their median (Rousseeuw and Leroy 1987).
@param parameters of the model, which reduce the degrees of freedom.
@param least lower bound of the result. */
inline double scaleWithin(
        const std::vector<double>& squared, double distance, int parameters, double least = .1)
{
    std::vector<double> near;
    for (double error : squared)
        if (error < square(distance))
            near.push_back(error);
    const double free = (double)near.size() - parameters;
    if (free <= 0)
        return std::max(distance / 3, least);
    return std::max(1.4826 * std::sqrt(median(near) * near.size() / free), least);
}

/** The same, and whether the errors below the distance look like those of right matches: most are far below it, and few are just
above it. */
inline bool findScale(const std::vector<double>& squared, double distance, int parameters, double& scale)
{
    const double most = .445;                // largest scale, of the distance
    const double wider = 4, mostMore = 1.5;  // within `wider` distances: at most `mostMore` times the errors
    const auto free = [&](double limit) {
        return (double)std::count_if(squared.begin(), squared.end(), [&](double error) {
            return error < square(limit);
        }) - parameters;
    };
    if (free(distance) <= 0)
        return false;
    scale = scaleWithin(squared, distance, parameters);
    return scale < most * distance && free(wider * distance) < mostMore * free(distance);
}

/** The model that most matches agree with. Deterministic. The scale of refined matches is tried with few samples, and twice that scale if
most errors are not far below it. */
template <class Problem> Fit<Problem> robustFit(const Problem& problem, int mostTrials = MANY_SAMPLES)
{
    const int fewest = 150, fewTrials = std::min(1000, mostTrials);
    Fit<Problem> fit;
    // Takes the best model of a search; returns whether its errors show a scale.
    const auto choose = [&](Search<Problem>& search, double scale, int trials) {
        fit.squared.clear();
        double least = std::numeric_limits<double>::infinity(), shown = scale;
        std::vector<double> squared;
        for (const typename Problem::Model& model : search.upTo(trials))
        {
            double sum = 0;
            problem.squaredErrors(model, squared);
            for (double error : squared)
                sum += std::min(error, square(FARTHEST_OF_CHOICE * scale));
            if (sum >= least)
                continue;
            least = sum;
            fit.model = model;
            fit.squared.swap(squared);
        }
        fit.samples = search.samples();
        const bool shows = findScale(fit.squared, FARTHEST_OF_CHOICE * scale, problem.parameters(), shown);
        fit.scale = shows ? shown : scale;
        return shows;
    };
    for (double scale : {REFINED, 2 * REFINED})
    {
        Search<Problem> search(problem, Loss{scale}, Loss{2 * scale}, fewest);
        const bool found = choose(search, scale, fewTrials);
        if ((found || scale > REFINED) && search.wantsMore())
            choose(search, scale, mostTrials);
        if (found)
            break;
    }
    if (fit.squared.empty())
        return fit;
    polish(problem, Loss{fit.scale}, FINELY, fit.model);
    problem.squaredErrors(fit.model, fit.squared);
    return fit;
}

}  // namespace cv::iib
