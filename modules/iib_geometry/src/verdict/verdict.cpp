// SPDX-License-Identifier: Apache-2.0
#include "verdict.hpp"

#include <algorithm>
#include <bitset>
#include <cmath>
#include <limits>
#include <set>

#include "../precomp.hpp"
#include "opencv2/iib/verdict.hpp"
#include "opencv2/imgproc.hpp"
#include "../common/points.hpp"

namespace cv::iib {
namespace {

double square(double x) { return x * x; }

const int CELLS = 32;           // of the diagonal of what the points span
const double CERTAINLY = 1e-3;  // chance
const double MODELS = 10;       // that a sample proposes, at most

//! The natural logarithm of n!, to ten digits (Abramowitz and Stegun, 6.1.40). C's lgamma writes its sign where all threads do.
double logFactorial(int n)
{
    double x = n + 1, below = 1;  // of the series, which is good from 10 on; and the factors that lead there
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

//! Matches of which some agree with a fundamental matrix or a homography, as errorsOfWrongMatches() has them.
class MarkedMatches
{
public:
    typedef Matx33d Model;

    MarkedMatches(const Mat& points1, const Mat& points2, bool epipolar)
        : first_(points1), second_(points2), epipolar_(epipolar)
    {
    }

    int size() const { return first_.rows; }

    MarkedMatches mixed(const std::vector<int>& order) const
    {
        MarkedMatches other(first_, second_.clone(), epipolar_);
        for (int i = 0; i < size(); i++)
            second_.row(order[i]).copyTo(other.second_.row(i));
        return other;
    }

    //! The one of those that are marked; false where these are too few or tell none.
    bool fit(const Verdict::Marks& marks, Matx33d& model) const
    {
        Mat chosen[2];
        for (int i = 0; i < size(); i++)
            if (marks[i])
            {
                chosen[0].push_back(first_.row(i));
                chosen[1].push_back(second_.row(i));
            }
        if (chosen[0].rows < (epipolar_ ? 8 : 4))
            return false;
        const Mat found = epipolar_ ? findFundamentalMat(chosen[0], chosen[1], FM_8POINT)
                                    : findHomography(chosen[0], chosen[1], 0);
        if (found.size() != Size(3, 3))
            return false;
        model = found;
        return true;
    }

    void squaredErrors(const Matx33d& model, std::vector<double>& errors) const
    {
        errors.resize(size());
        for (int i = 0; i < size(); i++)
        {
            const Point2d &a = first_.at<Point2d>(i), &b = second_.at<Point2d>(i);
            const Vec3d p(a.x, a.y, 1), q(b.x, b.y, 1), there = model * p, back = model.t() * q;
            const double line2 = square(there[0]) + square(there[1]) + square(back[0]) + square(back[1]);
            const Point2d beside(b.x - there[0] / there[2], b.y - there[1] / there[2]);
            errors[i] = epipolar_ ? square(q.dot(there)) / line2 : beside.ddot(beside);
        }
    }

private:
    Mat first_, second_;
    bool epipolar_;
};

double diagonal(const Size2d& size) { return std::hypot(size.width, size.height); }

}  // namespace

Verdict::Verdict(const Mat& points1, const Mat& points2)
{
    const bool oneImage = points1.data == points2.data;
    firsts_.resize(points1.rows);
    std::iota(firsts_.begin(), firsts_.end(), 0);
    for (int round = 0; round < 2; round++)  // what is outermost, places tell, however many matches they have
    {
        const Mat* const all[] = {&points1, &points2};
        for (int image = 0; image < 2; image++)
        {
            Mat ofPlaces;
            for (int i : firsts_)
                ofPlaces.push_back(all[image]->row(i));
            const Rect2d span = spanOf(ofPlaces);
            const double cell = diagonal(span.size()) / CELLS;
            cells_[image].clear();
            for (int i = 0; i < points1.rows; i++)
            {
                const double* p = all[image]->ptr<double>(i);
                const auto within = [&](double place) {
                    return (int)std::clamp(place / cell, 0., (double)CELLS);
                };
                cells_[image].push_back(within(p[1] - span.y) * (CELLS + 1) + within(p[0] - span.x));
            }
            spans_[image] = span.size();
        }
        std::set<std::pair<int, int>> known;
        firsts_.clear();
        for (int i = 0; i < points1.rows; i++)
            if (oneImage || known.insert({cells_[0][i], cells_[1][i]}).second)
                firsts_.push_back(i);
    }
}

int Verdict::places(const Marks& matches, int image) const
{
    std::bitset<(CELLS + 1) * (CELLS + 1)> cells;
    for (size_t i = 0; i < matches.size(); i++)
        if (matches[i])
            cells.set(cells_[image][i]);
    return (int)cells.count();
}

std::vector<double> Verdict::sumsOfPlaces(const std::vector<double>& values) const
{
    std::vector<double> sums((CELLS + 1) * (CELLS + 1));
    for (size_t i = 0; i < values.size(); i++)
        sums[cells_[0][i]] += values[i];
    return sums;
}

int Verdict::places(const Marks& matches) const { return std::min(places(matches, 0), places(matches, 1)); }

double Verdict::chance(Distance distance, double limit, const std::vector<double>& wrong) const
{
    const int few = 3;
    // Of a line, the nearer of two distances counts, in either image; of a point, that in the second one.
    const auto along = [&](const Size2d& span) { return 2 * limit * diagonal(span) / span.area(); };
    const double anywhere = distance == FROM_LINE ? std::max(along(spans_[0]), along(spans_[1]))
                                                  : CV_PI * limit * limit / spans_[1].area();
    const auto near = std::count_if(wrong.begin(), wrong.end(), [&](double e) { return e < limit * limit; });
    double share = 0;
    if (distance == FROM_POINT && !wrong.empty())
        // If none of so many is near, the chance may still be that of one more.
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
    const auto count = [](const Marks& marks) { return (int)std::count(marks.begin(), marks.end(), true); };
    double most = of(count(all), count(agreeing), chance);
    for (int image = 0; image < 2; image++)
        most = std::max(
                most, of(places(all, image), places(agreeing, image), chanceOfPlaces(all, chance, image)));
    return most;
}

bool Verdict::isOfOnePart(const Marks& agreeing, int sampleSize, double chance) const
{
    const int side = CELLS + 1;
    const Size parts[] = {{5, 5}, {12, 3}, {3, 12}};  // cells: a twentieth of the image
    const auto count = std::count_if(firsts_.begin(), firsts_.end(), [&](int i) { return agreeing[i]; });
    for (const std::vector<int>& cells : cells_)
        for (const Size& part : parts)
        {
            int most = 0;
            Point best;
            Mat counts(side, side, CV_64F, Scalar(0)), sums;
            for (int i : firsts_)
                counts.at<double>(cells[i] / side, cells[i] % side) += agreeing[i];
            integral(counts, sums, CV_64F);
            for (int y = 0; y + part.height <= side; y++)
                for (int x = 0; x + part.width <= side; x++)
                {
                    const int inside =
                            cvRound(sums.at<double>(y, x) + sums.at<double>(y + part.height, x + part.width) -
                                    sums.at<double>(y, x + part.width) - sums.at<double>(y + part.height, x));
                    if (inside > most)
                    {
                        most = inside;
                        best = Point(x, y);
                    }
                }
            if (2 * most <= count)
                continue;
            int others = 0, beside = 0;
            for (int i : firsts_)
                if (!Rect(best, part).contains(Point(cells[i] % side, cells[i] / side)))
                {
                    others++;
                    beside += agreeing[i];
                }
            // Some of the others the pose was fitted to.
            if (2 * beside < others && chanceOfSoMany(others, beside - sampleSize, chance) > CERTAINLY)
                return true;
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
    const Mat first = pointsOf(points1, "logFalseAlarms", "points1"),
              second = pointsOf(points2, "logFalseAlarms", "points2"), marks = inliers.getMat();
    checkMatched(first, second, "logFalseAlarms");
    if (!marks.empty() && marks.type() != CV_8U)
        CV_Error(Error::StsBadArg, "logFalseAlarms: inliers must be CV_8U, a mark for each match");
    if ((int)marks.total() != first.rows)
        CV_Error(Error::StsUnmatchedSizes, format("logFalseAlarms: inliers has %d marks for %d matches",
                                                   (int)marks.total(), first.rows));
    if (!(threshold > 0) || cvIsInf(threshold))
        CV_Error(Error::StsOutOfRange, "logFalseAlarms: threshold, in pixels, must be over 0 and finite");
    Verdict::Marks agreeing(first.rows);
    std::transform(
            marks.begin<uchar>(), marks.end<uchar>(), agreeing.begin(), [](uchar mark) { return mark != 0; });
    const MarkedMatches matches(first, second, epipolar);
    const Verdict verdict(first, second);
    Matx33d model;
    std::vector<double> wrong;
    if (matches.fit(agreeing, model))
        wrong = errorsOfWrongMatches(matches, model, verdict);
    return verdict.logFalseAlarms(Verdict::Marks(first.rows, true), agreeing, epipolar ? 7 : 4,
            verdict.chance(epipolar ? Verdict::FROM_LINE : Verdict::FROM_POINT, threshold, wrong));
}

}  // namespace cv::iib
