// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "opencv2/core.hpp"

namespace cv::iib {

//! The part of one image that the other one shows as well, in pixels of the first.
struct SharedPart
{
    double area = 0;                //!< pixels that both images show and masks allow
    double share = 0;               //!< of the pixels that the image's own mask allows
    std::vector<Point2f> points;    //!< keypoints there
    std::vector<Point2f> agreeing;  //!< matches that agree with a transform
    std::vector<double> values;     //!< of the pixels at these matches
};

/** Whether matches that agree show a place, or a logo or a caption that different pictures share. Each number is that of the image in which it
says less, so the order of the images does not matter. */
struct Spread
{
    /** The largest connected group of cells with matches. CELLS cells are as large as what the image with the larger share shows: a caption, which is
    a small group, stays one where pictures overlap little. */
    int connected = CELLS;
    double area = 0;  //!< of the matches' hull, over that of the keypoints' hull
    /** The matches' hull over the area of as many cells, without the few matches that enlarge it most: a transform bends towards as many wrong
    matches as determine it. */
    double whole = 1;
    double scatter = 0;  //!< number of cells with matches, over the number that as many keypoints would be in

    static constexpr int CELLS = 192;

    //! @param sampleSize matches that determine a transform.
    Spread(const SharedPart& reference, const SharedPart& image, int sampleSize);

    //! Whether these matches are one place, larger than a logo.
    bool isPlace(int matches) const;

    //! Whether the matches are all over the shared part.
    bool isEverywhere() const;
};

/** Whether the shared part lies over both images, such as captions, a frame or a part of the vehicle: there they are equal to the pixel, and elsewhere,
where both have keypoints, they differ. */
bool isOverlay(const SharedPart& reference, const SharedPart& image);

}  // namespace cv::iib
