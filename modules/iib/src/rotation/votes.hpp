// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#pragma once

#include "../precomp.hpp"

namespace cv {
namespace iib {

//! Votes of angles, whole degrees apart; with the sums of their parts of degrees.
class RotationVotes
{
public:
    RotationVotes() : counts(BINS), sums(BINS), any(false) {}

    //! @param degrees from 0 to 360.
    void add(double degrees)
    {
        const int bin = std::min((int)degrees, BINS - 1);
        counts[bin]++;
        sums[bin] += degrees - bin;
        any = true;
    }

    bool empty() const { return !any; }

    //! Degrees, 0 or more and less than 360: the mean of the votes around the peak.
    double peak() const
    {
        int best = 0;
        double most = -1;
        for (int i = 0; i < BINS; i++)
        {
            double score = 0;
            for (int j = -REACH; j <= REACH; j++)
                score += (REACH + 1 - std::abs(j)) * counts[(i + j + BINS) % BINS];
            if (score > most)
            {
                most = score;
                best = i;
            }
        }
        double count = 0, sum = 0;
        for (int j = -REACH; j <= REACH; j++)
        {
            const int bin = (best + j + BINS) % BINS;
            count += counts[bin];
            sum += counts[bin] * j + sums[bin];
        }
        const double angle = std::fmod(best + sum / count + 360, 360);
        return angle < 360 ? angle : 0;
    }

private:
    static constexpr int BINS = 360;
    static constexpr int REACH = 4;  //!< a vote counts for the bins this near, less for farther ones

    std::vector<double> counts, sums;
    bool any;
};

}  // namespace iib
}  // namespace cv
