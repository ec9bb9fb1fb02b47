// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

#include "../common/points.hpp"

namespace cv::iib {

//! Tests whether a model is significant by its number of false alarms, as cv::iib::logFalseAlarms explains.
class Verdict
{
public:
    typedef std::vector<bool> Marks;  //!< one for each match

    //! In pixels; the same object twice if only one side is an image.
    Verdict(const Points& points1, const Points& points2);

    //! Where a match's error is measured from.
    enum Distance
    {
        FROM_POINT,
        FROM_LINE
    };

    /** Logarithm to base 10 of the number of false alarms, at the error limit where it is smallest.
    @param squared errors of the matches, pixels^2.
    @param wrong errors of wrong matches (errorsOfWrongMatches()). Empty: wrong points are uniformly distributed.
    @param sampleSize matches that determine a model.
    @param limits to try, pixels.
    @param best if not null: the best limit. */
    double logFalseAlarms(const std::vector<double>& squared, const std::vector<double>& wrong,
            Distance distance, int sampleSize, const std::vector<double>& limits,
            double* best = nullptr) const;

    /** Chance that a wrong match is within the limit, 0 to 1. It is the larger of two: of uniformly distributed points, and the share of the
    wrong errors. If hardly any of these is within the limit, the share is extrapolated: of a point from one error more than there are, of a
    line from the nearest few, since its errors are uniformly distributed. */
    double chance(Distance distance, double limit, const std::vector<double>& wrong) const;

    //! @param chance that a wrong match agrees.
    double logFalseAlarms(const Marks& all, const Marks& agreeing, int sampleSize, double chance) const;

    /** Whether the agreeing matches are captions: more than half are in one small part of an image, or four fifths in up to four parts that are
    only shifted, and the other matches agree no better than wrong ones would.
    @param chance that a wrong match agrees. */
    bool isOfSmallParts(const Marks& agreeing, int sampleSize, double chance) const;

    //! The first match of each pair of places: neighbours are right or wrong together.
    const std::vector<int>& firstOfPlaces() const { return firsts_; }

    //! Sums of the matches' values over places of the first image.
    std::vector<double> sumsOfPlaces(const std::vector<double>& values) const;

    //! The matches whose places hold none of the others, in either image.
    Marks elsewhere(const Marks& matches, const Marks& others) const;

    //! Number of places with matches, in the image with fewer.
    int places(const Marks& matches) const;

    //! Logarithm of the number of false alarms below which a model is significant.
    static constexpr double CERTAIN = -3;

private:
    int places(const Marks& matches, int image) const;
    //! The chance that one of a place's matches agrees, mean over all places. Matches of one pair of places count once.
    double chanceOfPlaces(const Marks& all, double chance, int image) const;

    //! Number of the matches in a part of the image that have the median shift.
    double countOfOneShift(const Marks& matches, const std::function<bool(int)>& isInside) const;

    std::vector<int> cells_[2];  // of the matches
    std::vector<Point2d> shifts_;
    double cell_ = 0;  // pixels
    std::vector<int> firsts_;
    Size2d spans_[2];
};

/** Squared errors of about 4000 wrong matches, each made of the first point of one match and the second point of another. One match of each pair of
places is used.
@param errorOf squared error of the first point of one match with the second point of another. */
std::vector<double> errorsOfWrongMatches(
        const Verdict& verdict, const std::function<double(int, int)>& errorOf);

//! Which squared errors are below limit^2.
Verdict::Marks within(double limit, const std::vector<double>& squared);

inline int countOf(const Verdict::Marks& marks) { return (int)std::count(marks.begin(), marks.end(), true); }

}  // namespace cv::iib
