// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "opencv2/core.hpp"

namespace cv::iib {

/** An image as a camera farther away or beside it would see it: turned by an angle, then shortened along both axes (ASIFT's
simulated views; Morel and Yu 2009, section 2). */
struct View
{
    double longitude =
            0;  //!< radians by which the image is turned before it is shortened; 0 where both scales are equal
    Vec2d scales{1,
            1};  //!< of the turned image's width and height, over 0; over 1 in small images that are enlarged

    static View reduced(double scale) { return {0, {scale, scale}}; }
    static View tilted(double tilt, double longitude) { return {longitude, {1 / tilt, 1}}; }

    bool isImage() const { return longitude == 0 && scales == Vec2d(1, 1); }
    bool operator<(const View& other) const;

    Size sizeOf(const Size& image) const;

    //! Affine map from pixels of the image to pixels of the view; centres of pixels are at whole numbers in both.
    Matx33d fromImage(const Size& image) const;

    //! The image in the view, mirrored at its borders where the view shows more.
    Mat pixels(const Mat& image) const;

    /** Pixels of the view, CV_8UC1, that show the image and are not 0 in its mask; empty where that is all of them.
    @param mask of the image, or empty. */
    Mat mask(const Size& image, const Mat& mask) const;

private:
    Size turnedSize(const Size& image) const;
    Size shownSize(const Size& image) const;
    Matx33d turn(const Size& image) const;
};

//! Views of two images that show the same at one size and in one shape, and the angle that is left.
struct ViewPair
{
    View views[2];
    double angle =
            0;  //!< degrees, clockwise, 0 or more and less than 360, by which the second view is turned against the first

    /** The views of two images between which an affine map leads: along each axis the image that has more pixels is shortened.
    @param map from pixels of image 1 to pixels of image 2. */
    static ViewPair of(const Matx33d& map);

    /** The same, reduced to a longest side of `most` pixels, or enlarged up to twice towards `least` pixels: there small images have more
    points. */
    ViewPair within(int least, int most, const Size& image1, const Size& image2) const;
};

//! The derivative of a transform at a point, as an affine map with that point where the transform has it.
Matx33d affineAt(const Matx33d& transform, const Point2d& point);

//! The similarity nearest to an affine map's derivative, without a shift.
Matx33d similarityOf(const Matx33d& map);

//! Whether images that are seen in the views of one map are seen as well in those of another.
bool areAlike(const Matx33d& map, const Matx33d& other);

}  // namespace cv::iib
