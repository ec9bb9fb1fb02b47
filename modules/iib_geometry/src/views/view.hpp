// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "opencv2/core.hpp"

namespace cv::iib {

//! Pixels of the longer side at which images are matched, as HessianDetector has it.
const int WORKING_SIZE = 1024;

/** A simulated view from farther away or from the side: the image is rotated, then scaled along both axes (ASIFT; Morel
and Yu 2009, section 2). */
struct View
{
    double longitude = 0;  //!< radians by which the image is rotated; 0 if both scales are equal
    Vec2d scales{1, 1};    //!< of the rotated image's width and height; above 1 to enlarge small images

    static View reduced(double scale) { return {0, {scale, scale}}; }
    static View tilted(double tilt, double longitude) { return {longitude, {1 / tilt, 1}}; }

    bool isImage() const { return longitude == 0 && scales == Vec2d(1, 1); }
    bool operator<(const View& other) const;

    Size sizeOf(const Size& image) const;

    //! Affine map from pixels of the image to pixels of the view; pixel centres have integer coordinates.
    Matx33d fromImage(const Size& image) const;

    //! The view's pixels; beyond the image's borders the image is reflected.
    Mat pixels(const Mat& image) const;

    /** Mask of the view, CV_8UC1: pixels that show the image and its mask; empty for all pixels.
    @param mask of the image, or empty. */
    Mat mask(const Size& image, const Mat& mask) const;

private:
    Size turnedSize(const Size& image) const;
    Size shownSize(const Size& image) const;
    Matx33d turn(const Size& image) const;
};

//! Views of two images that show a scene at the same scale and shape, up to a rotation.
struct ViewPair
{
    View views[2];
    double angle = 0;  //!< degrees in [0, 360) by which the second view is rotated clockwise

    /** The views for an affine map between two images: along each axis, the image with more pixels is reduced.
    @param map from pixels of image 1 to pixels of image 2. */
    static ViewPair of(const Matx33d& map);

    /** The pair reduced, so that the part that both images show has a longest side of `most` pixels. Small views are enlarged up to twice, to get
    more points.
    @param map as in of(). */
    ViewPair within(int most, const Size& image1, const Size& image2, const Matx33d& map) const;
};

/** The corners of an image, with a margin, mapped to another image.
@param map from pixels of the image to pixels of the other image. @param share of the image's size. */
std::vector<Point2d> cornersAround(const Size& image, const Matx33d& map, double share = .1);

//! The pixels of an image around some points.
Rect boxOf(const std::vector<Point2d>& points, const Size& image);

//! The affine map that approximates a transform at a point.
Matx33d affineAt(const Matx33d& transform, const Point2d& point);

//! The similarity nearest to an affine map, with its translation.
Matx33d similarityOf(const Matx33d& map);

//! Largest rotation (radians) and scale between images that match as they are.
constexpr double MOST_TURN = 8 * CV_PI / 180, MOST_SCALE = 1.2;

//! Whether the views of two maps are so similar that images match equally well in both.
bool haveSimilarViews(const Matx33d& map, const Matx33d& other);

//! Whether two maps, from a reference to an image of some size, place the image at about the same part of the reference.
bool showSameParts(const Matx33d& map, const Matx33d& other, const Size& image);

}  // namespace cv::iib
