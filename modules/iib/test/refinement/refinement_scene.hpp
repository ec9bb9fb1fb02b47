// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#pragma once

#include "../test_precomp.hpp"

namespace opencv_test {

/** Two views of one scene, 640 x 480: the second is deformed by an affine warp (10 %, 5 degrees) and darker, with a
 gradient of light and an offset; both with noise of 2 grey levels. Matches of true places, moved by up to .6 pixels in
 x and y. */
struct RefinementScene
{
    Mat images[2];
    std::vector<KeyPoint> keypoints[2];
    std::vector<DMatch> matches;
    Matx22d linear;  //!< of the warp from the first image to the second
    Vec2d shift;

    explicit RefinementScene(int seed);
    //! The true place of a point of the first image in the second.
    Point2d truth(const Point2f& point) const;

    //! The scene of seed 7, which is made once.
    static const RefinementScene& seven();
};

//! Results of refineMatches() and propagateMatches(), with their matches.
struct Refined
{
    std::vector<DMatch> matches;
    Mat points1, points2, covariances, similarities;
};

Refined refine(const Mat& image1, const std::vector<KeyPoint>& keypoints1, const Mat& image2,
        const std::vector<KeyPoint>& keypoints2, const std::vector<DMatch>& matches);
Refined refine(const RefinementScene& scene);

//! Expects that `actual` begins with `expected`.
void expectSame(const Refined& expected, const Refined& actual);

//! Mahalanobis distance of an error. @param c xx, xy and yy.
double inSigmas(const Point2d& error, const Point3d& c);

}  // namespace opencv_test
