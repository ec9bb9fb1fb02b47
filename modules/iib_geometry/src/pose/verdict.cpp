// SPDX-License-Identifier: Apache-2.0
#include "verdict.hpp"

#include <algorithm>
#include <bitset>
#include <cmath>
#include <limits>

#include "opencv2/iib/verdict.hpp"
#include "points.hpp"

namespace cv::iib {
namespace {

const int CELLS = 32;  // of the diagonal of what the points span
const double LARGEST_CHANCE = .5;
const double MODELS = 10;  // that a sample proposes, at most

double logBinomial(int n, int k)
{
    return (std::lgamma(n + 1.) - std::lgamma(k + 1.) - std::lgamma(n - k + 1.)) / std::log(10.);
}

double diagonal(const Size2d& size) { return std::hypot(size.width, size.height); }

}  // namespace

Verdict::Verdict(const Mat& points1, const Mat& points2)
{
    const Mat* const all[] = {&points1, &points2};
    for (int image = 0; image < 2; image++)
    {
        const Mat& points = *all[image];
        const Rect2d span = spanOf(points);
        const double cell = diagonal(span.size()) / CELLS;
        for (int i = 0; i < points.rows; i++)
        {
            const double* p = points.ptr<double>(i);
            const auto within = [&](double place) {
                return (int)std::clamp(place / cell, 0., (double)CELLS);
            };
            cells_[image].push_back(within(p[1] - span.y) * (CELLS + 1) + within(p[0] - span.x));
        }
        span_ = span.size();
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

int Verdict::places(const Marks& matches) const { return std::min(places(matches, 0), places(matches, 1)); }

double Verdict::chance(Distance distance, double limit) const
{
    const double area = distance == FROM_LINE ? 2 * limit * diagonal(span_) : CV_PI * limit * limit;
    return area / span_.area();
}

double Verdict::logFalseAlarms(const Marks& all, const Marks& agreeing, int sampleSize, double chance) const
{
    double most = -std::numeric_limits<double>::infinity();
    for (int image = 0; image < 2; image++)
    {
        const int n = places(all, image), k = places(agreeing, image);
        if (k <= sampleSize)
            return std::numeric_limits<double>::infinity();
        most = std::max(most, std::log10(MODELS * (n - sampleSize)) + logBinomial(n, k) +
                                      logBinomial(k, sampleSize) +
                                      (k - sampleSize) * std::log10(std::min(chance, LARGEST_CHANCE)));
    }
    return most;
}

double Verdict::logFalseAlarms(const std::vector<double>& squared, Distance distance, int sampleSize,
        const std::vector<double>& limits) const
{
    double least = std::numeric_limits<double>::infinity();
    for (double limit : limits)
    {
        const double area = distance == FROM_LINE ? 2 * limit * diagonal(span_) : CV_PI * limit * limit;
        least = std::min(least, logFalseAlarms(Marks(squared.size(), true), within(limit, squared),
                                        sampleSize, area / span_.area()));
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
    const Verdict verdict(first, second);
    return verdict.logFalseAlarms(Verdict::Marks(first.rows, true), agreeing, epipolar ? 7 : 4,
            verdict.chance(epipolar ? Verdict::FROM_LINE : Verdict::FROM_POINT, threshold));
}

}  // namespace cv::iib
