// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "opencv2/core.hpp"

namespace cv::iib {

//! What one of two images has where the other one shows the same, in its pixels.
struct SharedPart
{
    double area;                    //!< that both show and masks allow, pixels
    std::vector<Point2f> points;    //!< that were looked for there
    std::vector<Point2f> agreeing;  //!< matches that agree with a transform
    std::vector<double> values;     //!< of the pixels where these are
};

/** Whether matches that agree are of a place, or of a logo or a caption that different pictures have in common. Each number is of the image
in which it says less, so that it does not matter which image is the reference. */
struct Spread
{
    /** Cells that touch each other and all hold matches that agree, of CELLS cells of the area that both show: the largest such group. A place is a
    large group whatever lies beside it; captions are small groups. */
    int connected;
    //! Area that matches span, of the area that points span.
    double area;
    /** The same of all that both show, without the few matches that stretch it most: a transform bends towards as many wrong ones as determine
    it. */
    double whole;
    double scatter;  //!< cells with matches, over those in which as many points would be

    static constexpr int CELLS = 192;

    //! Pixels of a cell's side, of the area that both images show.
    static double cellOf(double area) { return std::sqrt(std::max(area, 1.) / CELLS); }

    //! @param sampleSize matches that determine a transform.
    Spread(const SharedPart& reference, const SharedPart& image, int sampleSize);

    //! Whether the matches, of this number, are of one place, larger than logos are.
    bool isPlace(int matches) const;

    //! Whether they are all over what both images show.
    bool isEverywhere() const;
};

}  // namespace cv::iib
