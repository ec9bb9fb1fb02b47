// SPDX-License-Identifier: Apache-2.0
#include "verdict.hpp"

#include <bitset>
#include <cmath>
#include <limits>
#include <numeric>
#include <unordered_set>

#include "../precomp.hpp"
#include "opencv2/iib/verdict.hpp"
#include "opencv2/imgproc.hpp"

namespace cv::iib {
namespace {

const int CELLS = 32;           // of the diagonal of what the points span
const double CERTAINLY = 1e-3;  // chance
const double MODELS = 10;       // largest number that a sample proposes

//! Natural logarithm of n!, to ten digits (Abramowitz and Stegun, 6.1.40). C's lgamma is not safe for threads.
double logFactorial(int n)
{
    double x = n + 1, below = 1;  // the series is accurate from 10 on; below: the factors up to there
    for (; x < 10; x++)
        below *= x;
    const double series = (1 / 12. - (1 / 360. - 1 / (1260 * x * x)) / (x * x)) / x;
    return (x - .5) * std::log(x) - x + .5 * std::log(2 * CV_PI) + series - std::log(below);
}

double logBinomial(int n, int k)
{
    return (logFactorial(n) - logFactorial(k) - logFactorial(n - k)) / std::log(10.);
}

//! The chance that k or more of n matches agree, each by a chance of its own.
double chanceOfSoMany(int n, int k, double each)
{
    if (k <= 0 || each >= 1)
        return 1;
    double sum = 0;
    for (int j = k; j <= n; j++)
        sum += std::pow(10., logBinomial(n, j) + j * std::log10(each) + (n - j) * std::log10(1 - each));
    return sum;
}

/** The fundamental matrix or homography of the marked matches.
@return empty if they are too few or lie on one line. */
Mat modelOf(const Points& points1, const Points& points2, const Verdict::Marks& marks, bool epipolar)
{
    Points chosen[2];
    for (size_t i = 0; i < marks.size(); i++)
        if (marks[i])
        {
            chosen[0].push_back(points1[i]);
            chosen[1].push_back(points2[i]);
        }
    if (chosen[0].size() < (epipolar ? 8 : 4))
        return Mat();
    const Mat found = epipolar ? findFundamentalMat(chosen[0], chosen[1], FM_8POINT)
                               : findHomography(chosen[0], chosen[1], 0);
    return found.size() == Size(3, 3) ? found : Mat();
}

double diagonal(const Size2d& size) { return std::hypot(size.width, size.height); }

typedef std::bitset<(CELLS + 1) * (CELLS + 1)> Cells;

Cells cellsOf(const Verdict::Marks& matches, const std::vector<int>& cellOf)
{
    Cells cells;
    for (size_t i = 0; i < matches.size(); i++)
        if (matches[i])
            cells.set(cellOf[i]);
    return cells;
}

}  // namespace

Verdict::Verdict(const Points& points1, const Points& points2)
{
    const Points* const all[] = {&points1, &points2};
    const int count = (int)points1.size();
    for (int i = 0; i < count; i++)
        shifts_.push_back(points2[i] - points1[i]);
    firsts_.resize(count);
    std::iota(firsts_.begin(), firsts_.end(), 0);
    for (int round = 0; round < 2; round++)  // the second time, the span is that of places, not of matches
    {
        for (int image = 0; image < 2; image++)
        {
            Points ofPlaces;
            for (int i : firsts_)
                ofPlaces.push_back((*all[image])[i]);
            const Rect2d span = spanOf(ofPlaces);
            const double cell = cell_ = diagonal(span.size()) / CELLS;
            const auto within = [&](double place) {
                return (int)std::clamp(place / cell, 0., (double)CELLS);
            };
            cells_[image].clear();
            for (const Point2d& p : *all[image])
                cells_[image].push_back(within(p.y - span.y) * (CELLS + 1) + within(p.x - span.x));
            spans_[image] = span.size();
        }
        std::unordered_set<size_t> known(count);
        firsts_.clear();
        for (int i = 0; i < count; i++)
            if (all[0] == all[1] || known.insert(cells_[0][i] * Cells().size() + cells_[1][i]).second)
                firsts_.push_back(i);
    }
}

std::vector<double> Verdict::sumsOfPlaces(const std::vector<double>& values) const
{
    std::vector<double> sums((CELLS + 1) * (CELLS + 1));
    for (size_t i = 0; i < values.size(); i++)
        sums[cells_[0][i]] += values[i];
    return sums;
}

Verdict::Marks Verdict::elsewhere(const Marks& matches, const Marks& others) const
{
    Marks result = matches;
    for (const std::vector<int>& cells : cells_)
    {
        const Cells taken = cellsOf(others, cells);
        for (size_t i = 0; i < result.size(); i++)
            result[i] = result[i] && !taken[cells[i]];
    }
    return result;
}

int Verdict::places(const Marks& matches, int image) const
{
    return (int)cellsOf(matches, cells_[image]).count();
}

int Verdict::places(const Marks& matches) const { return std::min(places(matches, 0), places(matches, 1)); }

double Verdict::chance(Distance distance, double limit, const std::vector<double>& wrong) const
{
    const int few = 3;
    // The error from a line is the smaller of both images', from a point that of the second image.
    const auto along = [&](const Size2d& span) { return 2 * limit * diagonal(span) / span.area(); };
    const double anywhere = distance == FROM_LINE ? std::max(along(spans_[0]), along(spans_[1]))
                                                  : CV_PI * limit * limit / spans_[1].area();
    const auto near = std::count_if(wrong.begin(), wrong.end(), [&](double e) { return e < limit * limit; });
    double share = 0;
    if (distance == FROM_POINT && !wrong.empty())
        share = std::max((double)near / (double)wrong.size(), 1. / (double)(wrong.size() + 1));
    else if (near >= few || (int)wrong.size() < few)
        share = (double)near / std::max<double>((double)wrong.size(), 1);
    else
    {
        std::vector<double> nearest = wrong;
        std::nth_element(nearest.begin(), nearest.begin() + few - 1, nearest.end());
        share = few / (double)wrong.size() * limit / std::sqrt(nearest[few - 1]);
    }
    return std::clamp(share, std::min(anywhere, 1.), 1.);
}

double Verdict::chanceOfPlaces(const Marks& all, double chance, int image) const
{
    std::vector<int> counts((CELLS + 1) * (CELLS + 1));
    for (int i : firsts_)
        counts[cells_[image][i]] += all[i];
    double sum = 0, places = 0;
    for (int count : counts)
        if (count > 0)
        {
            sum += 1 - std::pow(1 - chance, count);
            places++;
        }
    return places > 0 ? sum / places : 1;
}

double Verdict::logFalseAlarms(const Marks& all, const Marks& agreeing, int sampleSize, double chance) const
{
    const auto of = [&](int n, int k, double each) {
        return k > sampleSize ? std::log10(MODELS * (n - sampleSize)) + logBinomial(n, k) +
                                        logBinomial(k, sampleSize) + (k - sampleSize) * std::log10(each)
                              : std::numeric_limits<double>::infinity();
    };
    double most = of(countOf(all), countOf(agreeing), chance);
    for (int image = 0; image < 2; image++)
        most = std::max(
                most, of(places(all, image), places(agreeing, image), chanceOfPlaces(all, chance, image)));
    return most;
}

double Verdict::countOfOneShift(const Marks& matches, const std::function<bool(int)>& isInside) const
{
    const double near = 1 / 25.;  // of a cell's side: a pixel of a small image
    std::vector<int> all;
    for (int i : firsts_)
        if (matches[i] && isInside(i))
            all.push_back(i);
    if (all.empty())
        return 0;
    Point2d middle;
    for (double Point2d::*axis : {&Point2d::x, &Point2d::y})
    {
        const auto half = all.begin() + (ptrdiff_t)all.size() / 2;
        std::nth_element(all.begin(), half, all.end(),
                [&](int a, int b) { return shifts_[a].*axis < shifts_[b].*axis; });
        middle.*axis = shifts_[*half].*axis;
    }
    return (double)std::count_if(
            all.begin(), all.end(), [&](int i) { return norm(shifts_[i] - middle) < near * cell_; });
}

bool Verdict::isOfSmallParts(const Marks& agreeing, int sampleSize, double chance) const
{
    const int side = CELLS + 1, mostParts = 4;
    const double mostShifted = .6;
    const double share[] = {.5, .8, .8, .8};          // of the matches that agree, in the first 1 to 4 parts
    const Size sizes[] = {{5, 5}, {12, 3}, {3, 12}};  // of a part, cells: a twentieth of the image
    for (const std::vector<int>& cells : cells_)
    {
        Mat all(side, side, CV_64F, Scalar(0)), counts = all.clone(), sums;
        for (int i : firsts_)
        {
            all.at<double>(cells[i] / side, cells[i] % side)++;
            counts.at<double>(cells[i] / side, cells[i] % side) += agreeing[i];
        }
        const double count = sum(counts)[0];
        double inside = 0, shifted = 0;
        for (int part = 0; part < mostParts; part++)
        {
            double most = 0;
            Rect best;
            integral(counts, sums, CV_64F);
            for (const Size& size : sizes)
                for (int y = 0; y + size.height <= side; y++)
                    for (int x = 0; x + size.width <= side; x++)
                    {
                        const double *top = sums.ptr<double>(y, x),
                                     *bottom = sums.ptr<double>(y + size.height, x);
                        const double here = bottom[size.width] - bottom[0] - top[size.width] + top[0];
                        if (here > most)
                        {
                            most = here;
                            best = Rect(Point(x, y), size);
                        }
                    }
            all(best) = 0;
            counts(best) = 0;
            const auto isInside = [&](int i) {
                return best.contains(Point(cells[i] % side, cells[i] / side));
            };
            shifted += countOfOneShift(agreeing, isInside);
            inside += most;
            const bool isShifted = shifted > mostShifted * inside;
            if (inside <= share[part] * count || (part > 0 && !isShifted))
                continue;
            const int others = (int)sum(all)[0], beside = (int)(count - inside);
            // The pose was fitted to some of the others, to more where a shift leaves it free to turn.
            const int fitted = isShifted ? 2 * sampleSize : sampleSize;
            if (2 * beside < others && chanceOfSoMany(others, beside - fitted, chance) > CERTAINLY)
                return true;
        }
    }
    return false;
}

double Verdict::logFalseAlarms(const std::vector<double>& squared, const std::vector<double>& wrong,
        Distance distance, int sampleSize, const std::vector<double>& limits, double* best) const
{
    double least = std::numeric_limits<double>::infinity();
    for (double limit : limits)
    {
        const double alarms = logFalseAlarms(Marks(squared.size(), true), within(limit, squared), sampleSize,
                chance(distance, limit, wrong));
        if (alarms >= least)
            continue;
        least = alarms;
        if (best)
            *best = limit;
    }
    return least + std::log10((double)limits.size());
}

std::vector<double> errorsOfWrongMatches(
        const Verdict& verdict, const std::function<double(int, int)>& errorOf)
{
    const size_t enough = 4096;
    const std::vector<int>& firsts = verdict.firstOfPlaces();
    const int n = (int)firsts.size();
    RNG random(0x5eed);
    std::vector<double> errors;
    for (int round = 1; round < n && errors.size() < enough; round++)
        for (int i = 0; i < n; i++)
            errors.push_back(errorOf(firsts[i], firsts[(i + random.uniform(1, n)) % n]));
    return errors;
}

Verdict::Marks within(double limit, const std::vector<double>& squared)
{
    Verdict::Marks marks(squared.size());
    for (size_t i = 0; i < squared.size(); i++)
        marks[i] = squared[i] < limit * limit;
    return marks;
}

double logFalseAlarms(
        InputArray points1, InputArray points2, InputArray inliers, bool epipolar, double threshold)
{
    const Points first = pointsOf(points1, "logFalseAlarms", "points1"),
                 second = pointsOf(points2, "logFalseAlarms", "points2");
    const Mat marks = inliers.getMat();
    checkMatched(first, second, "logFalseAlarms");
    if (!marks.empty() && marks.type() != CV_8U)
        CV_Error(Error::StsBadArg, "logFalseAlarms: inliers must be CV_8U, a mark for each match");
    if (marks.total() != first.size())
        CV_Error(Error::StsUnmatchedSizes, format("logFalseAlarms: inliers has %d marks for %d matches",
                                                   (int)marks.total(), (int)first.size()));
    if (!(threshold > 0) || cvIsInf(threshold))
        CV_Error(Error::StsOutOfRange, "logFalseAlarms: threshold, in pixels, must be over 0 and finite");
    Verdict::Marks agreeing(first.size());
    std::transform(
            marks.begin<uchar>(), marks.end<uchar>(), agreeing.begin(), [](uchar mark) { return mark != 0; });
    const Verdict verdict(first, second);
    std::vector<double> wrong;
    const Mat found = modelOf(first, second, agreeing, epipolar);
    if (!found.empty())
    {
        const Matx33d model(found);
        wrong = errorsOfWrongMatches(verdict, [&](int i, int j) {
            const Point2d &a = first[i], &b = second[j];
            const Vec3d p(a.x, a.y, 1), q(b.x, b.y, 1), there = model * p, back = model.t() * q;
            const double line2 = square(there[0]) + square(there[1]) + square(back[0]) + square(back[1]);
            const Point2d beside(b.x - there[0] / there[2], b.y - there[1] / there[2]);
            return epipolar ? square(q.dot(there)) / line2 : beside.ddot(beside);
        });
    }
    return verdict.logFalseAlarms(Verdict::Marks(first.size(), true), agreeing, epipolar ? 7 : 4,
            verdict.chance(epipolar ? Verdict::FROM_LINE : Verdict::FROM_POINT, threshold, wrong));
}

double confidenceLimit(double probability, int dimensions)
{
    const double share = .25;  // scale matrix over covariance: chosen on rendered places
    if (!(probability >= 0 && probability < 1))
        CV_Error(Error::StsOutOfRange,
                format("confidenceLimit: probability is %g; it is 0 or more and below 1", probability));
    if (dimensions < 1)
        CV_Error(Error::StsOutOfRange,
                format("confidenceLimit: dimensions is %d; it is 1 or more", dimensions));
    // Student's t with two degrees of freedom in d dimensions is inside m with probability (m / (m + 2 share))^(d / 2).
    const double root = std::pow(probability, 2. / dimensions);
    return 2 * share * root / (1 - root);
}

}  // namespace cv::iib
