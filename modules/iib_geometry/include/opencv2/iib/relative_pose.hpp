// SPDX-License-Identifier: Apache-2.0
#ifndef OPENCV_IIB_RELATIVE_POSE_HPP
#define OPENCV_IIB_RELATIVE_POSE_HPP

#include "opencv2/core.hpp"

namespace cv { namespace iib {

//! @addtogroup iib_geometry
//! @{

/** @brief Finds where camera 2 stands, seen from camera 1, from matched points.

A point \f$X\f$ in the axes of camera 1 is \f$RX + \lambda t\f$ in those of camera 2; matches do not tell the length
\f$\lambda\f$. Samples of five matches propose poses @cite Nister2004. Those that agree best are polished by Levenberg-Marquardt on
Sampson's error (@cite HartleyZisserman2004, equation 11.9) under Cauchy's loss. Where few samples were right, further ones are taken
from the matches that agree with the best pose so far. Of the candidates that one is chosen that has the least sum of squared errors, cut
off at seven thresholds from .35 to 3 pixels, of points in front of both cameras. Wrong matches are expected; the same input gives the
same answer, whatever the number of threads, and swapped images give the inverse.

Where the matches that agree are not more than chance there is no pose: if poses that agree as well are expected more than once
in a thousand tries among wrong matches (the number of false alarms, @cite MoisanStival2004). It is counted in matches, and in cells
of a 32nd of the diagonal of what the points span, since matches beside each other may be wrong together; the larger number counts. How
often a wrong match agrees is what points of different matches do with the pose, so that a skyline is no pose. Nor is there one where
most of the places that agree are in a twentieth of an image, and the others agree no more than chance would have it, as with a caption.

There is none either where a second pose, far outside of the covariance, explains the matches as well but for what noise may give. One
of the plane that most of the matches lie on must be turned by 3 degrees or more, another one by 6. Where it turns less, or nothing shows
the direction of t, the covariance is enlarged to reach it. Matches behind a camera, or of a parallax of which so many are wrong that the
near ones may be near by chance, count neither in the last fit nor in the covariance. Of exact planes, 200 and 800 matches
with noise of .2 pixels, half of the poses or more are right, and a third or more refused (`of_a_plane_is_right_or_refused` of RelativePose).

How often that errs, with 2000 points by the recommended chain, propagated: none of 446 pairs of images of different places had a pose; of 144
pairs of sixteen rendered places in other light 142 had one (the documentation's page "How sure", made by
`iib_evaluation --only uncertainty`, which tells how many were as right as they said).

Points must be free of lens distortion: `cv::undistortPoints(points, undistorted, K, distortion, noArray(), K)` first.
Matches that cv::iib::refineMatches refined make the pose more accurate where the light changed.

@param points1 the points in image 1: N x 2, or N of two channels, CV_32F or CV_64F; pixels, whole at the centres
@param points2 their matches in image 2, of the same number and type
@param cameraMatrix1 3 x 3, CV_32F or CV_64F, of camera 1: [fx 0 cx; 0 fy cy; 0 0 1], pixels
@param cameraMatrix2 the same of camera 2
@param R 3 x 3, CV_64F: from the axes of camera 1 to those of camera 2
@param t 3 x 1, CV_64F, of length 1: direction of the translation, in the axes of camera 2
@param inliers N x 1, CV_8U: 1 for matches within three scales of the pose (three quarters of a pixel at least), and in front of both
    cameras unless they are too far away to tell; else 0. Without a pose, those that agreed best
@param scale Cauchy's scale in pixels: about the standard deviation of the points; 0: the residuals tell it, from .1 pixel to a
    hundredth of the diagonal of what the points span; less than .1 counts as .1. The covariance is that of the residuals even if
    they are larger than a scale that is given
@param covariance 5 x 5, CV_64F, of the errors of the pose in radians: three numbers of a rotation vector \f$w\f$ in the
    axes of camera 2, where the true rotation is \f$\exp([w]_\times) R\f$; two of the direction of t, along \f$b\f$ and
    \f$t \times b\f$, where \f$b\f$ is the unit vector along \f$t \times e\f$ and \f$e\f$ the axis along which t is
    shortest. It tells by how much parts of the image disagree, so that it knows of shadows that move a region; what all matches have
    in common, such as a wrong camera matrix, is not in it. A number that nothing tells, such as the direction of t where the camera
    only turned or all the points are far away, has a deviation of a radian or more. Of 10 matches with noise of a pixel 75 % of
    the errors are inside the told 95 %, of 15 or more 90 %
@param reason if not null: why there is no pose, a sentence; empty if there is one
@param covariances N x 3, CV_32F or CV_64F, pixels^2: of the places of the matches, xx, xy, yy, as refineMatches and propagateMatches give them. What
    was located less exactly then counts less in the choice among poses: by 1 / sqrt(1 + sum of both variances). Empty: all count alike
@return false, with R, t and covariance empty (NaN where their size is fixed), if random matches or matches displaced at
    random would agree as well, or two poses explain the matches equally well
@throws cv::Exception for points of a wrong type or of different numbers, points that are not finite, matrices that are
    not a camera's, covariances of another type or number, or a scale that is negative or not finite */
CV_EXPORTS_W bool findRelativePose(InputArray points1, InputArray points2, InputArray cameraMatrix1,
        InputArray cameraMatrix2, OutputArray R, OutputArray t, OutputArray inliers = noArray(),
        double scale = 0, OutputArray covariance = noArray(), CV_OUT String* reason = nullptr,
        InputArray covariances = noArray());

//! @}

}}  // namespace cv::iib

#endif
