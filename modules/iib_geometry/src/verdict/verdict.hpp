// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <vector>

#include "opencv2/core.hpp"

namespace cv::iib {

/** Tells whether matches agree with a model by more than chance, by the number of false alarms: how many models that agree as well
are expected among wrong matches (Moisan and Stival 2004, section 3). It is counted in matches and in places, cells of a 32nd of the
diagonal of what the points span, since matches beside each other may be wrong together; the larger one counts. */
class Verdict
{
public:
    typedef std::vector<bool> Marks;  //!< of the matches

    //! Both N x 2, CV_64F, pixels; of matches with what is no image, the same points twice.
    Verdict(const Mat& points1, const Mat& points2);

    //! What a match's error is the distance from.
    enum Distance
    {
        FROM_POINT,
        FROM_LINE
    };

    /** Logarithm to base 10 of the number of false alarms, at that limit of the errors at which it is least.
    @param squared errors of the matches, pixels^2.
    @param wrong such errors of wrong matches: see errorsOfWrongMatches(). Empty: only points that are anywhere count.
    @param sampleSize matches that give a model.
    @param limits to try, pixels.
    @param best if not null: that limit. */
    double logFalseAlarms(const std::vector<double>& squared, const std::vector<double>& wrong,
            Distance distance, int sampleSize, const std::vector<double>& limits,
            double* best = nullptr) const;

    /** Chance that a wrong match is so near, 0 to 1: as of points that are anywhere, or, where points gather, as those errors tell. Where
    hardly one of them is so near, of a point it is at least that of one in more than there are, and of a line, from which errors are as
    frequent at any small distance, that of the nearest few. */
    double chance(Distance distance, double limit, const std::vector<double>& wrong) const;

    /** The same of matches that agree or not.
    @param chance that a wrong match agrees. */
    double logFalseAlarms(const Marks& all, const Marks& agreeing, int sampleSize, double chance) const;

    /** Whether more than half of the matches that agree are in one small part of an image, or four fifths in up to four each of which is only
    shifted, and the others agree no more than chance would have it: captions are no scene.
    @param chance that a wrong match agrees. */
    bool isOfSmallParts(const Marks& agreeing, int sampleSize, double chance) const;

    //! Of the matches from one place to one place, the first: neighbours are right or wrong together.
    const std::vector<int>& firstOfPlaces() const { return firsts_; }

    //! Of a number of each match: the sums over places of the first image that have any.
    std::vector<double> sumsOfPlaces(const std::vector<double>& values) const;

    //! Matches in places in which none of the others is, in either image.
    Marks elsewhere(const Marks& matches, const Marks& others) const;

    //! Number of places of the matches, in the image where they have fewer.
    int places(const Marks& matches) const;

    //! Above this, a model may be chance.
    static constexpr double CERTAIN = -3;

private:
    int places(const Marks& matches, int image) const;
    //! That one of a place's matches agrees: the mean over all places. Those from one place to one place are one.
    double chanceOfPlaces(const Marks& all, double chance, int image) const;

    //! Of matches in a part of the image, those that are shifted like most.
    double countOfOneShift(const Marks& matches, const std::function<bool(int)>& isInside) const;

    std::vector<int> cells_[2];  // of the matches
    std::vector<Point2d> shifts_;
    double cell_ = 0;  // pixels
    std::vector<int> firsts_;
    Size2d spans_[2];
};

/** Squared errors of wrong matches, about 4000: of those between a point of one match and the other point of another one. Of neighbours
one counts: mixed, they are not wrong.
@param errorOf squared error of the first point of one match with the second point of another. */
std::vector<double> errorsOfWrongMatches(
        const Verdict& verdict, const std::function<double(int, int)>& errorOf);

//! Which squared errors are below limit^2.
Verdict::Marks within(double limit, const std::vector<double>& squared);

}  // namespace cv::iib
