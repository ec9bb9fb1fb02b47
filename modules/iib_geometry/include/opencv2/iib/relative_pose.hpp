// SPDX-License-Identifier: Apache-2.0
#ifndef OPENCV_IIB_RELATIVE_POSE_HPP
#define OPENCV_IIB_RELATIVE_POSE_HPP

#include "opencv2/core.hpp"

namespace cv { namespace iib {

//! @addtogroup iib_geometry
//! @{

/** @brief Estimates the pose of camera 2 relative to camera 1 from matched points, many of which may be wrong.

A point \f$X\f$ in camera 1's axes is \f$RX + \lambda t\f$ in camera 2's axes. Matches do not determine the length \f$\lambda\f$.

- Samples of five matches propose poses @cite Nister2004. The best ones are polished by Levenberg-Marquardt on Sampson's error
  (@cite HartleyZisserman2004, equation 11.9) under Cauchy's loss.
- If few samples were free of wrong matches, further samples come from the inliers of the best pose.
- Candidates are compared by their squared errors, cut off at seven thresholds at once. A match behind a camera counts as a point at infinity.
- The result does not depend on the number of threads, and swapped images give the inverse.

There is no pose, and `reason` says why, where
- the inliers are not significant: poses that agree as well are expected more than once in a thousand sets of random matches (logFalseAlarms);
- most inliers are in small parts of the image, such as a logo or a caption, and the other matches agree no better than random ones;
- a second pose, far outside of the covariance, explains the matches as well. The other pose of a plane counts if it is rotated by 3 degrees or more,
  any other pose from 6 degrees on.

If the second pose is rotated by less, or the direction of t is not significant, the covariance is enlarged to include it. The final fit and the
covariance leave out inliers that are probably wrong: most matches of a similar parallax are outliers. doc/uncertainty.md counts wrong poses, and
errors inside their limits, by kind of data.

Remove lens distortion from the points first: `cv::undistortPoints(points, undistorted, K, distortion, noArray(), K)`.
Refined matches (cv::iib::refineMatches) make the pose more accurate.

@param points1 the points in image 1: N x 2, or N of two channels, CV_32F or CV_64F; pixels, whole at the centres
@param points2 their matches in image 2, of the same number and type
@param cameraMatrix1 3 x 3, CV_32F or CV_64F, of camera 1: [fx 0 cx; 0 fy cy; 0 0 1], pixels
@param cameraMatrix2 the same of camera 2
@param R 3 x 3, CV_64F: from the axes of camera 1 to those of camera 2
@param t 3 x 1, CV_64F, of length 1: direction of the translation, in the axes of camera 2
@param inliers N x 1, CV_8U: 1 for matches within three scales of the pose, or within .75 pixels if that is more. Points behind a camera are no
    inliers, unless they are nearly at infinity. Without a pose: the inliers of the best candidate
@param scale Cauchy's scale in pixels, about the standard deviation of the points; at least .1. 0: estimated from the residuals, up to a
    hundredth of the diagonal of the points' span. The covariance uses the residuals even if they are larger than a given scale
@param covariance 5 x 5, CV_64F, of the errors of the pose in radians: three numbers of a rotation vector \f$w\f$ in the
    axes of camera 2, where the true rotation is \f$\exp([w]_\times) R\f$; two of the direction of t, along \f$b\f$ and
    \f$t \times b\f$, where \f$b\f$ is the unit vector along \f$t \times e\f$ and \f$e\f$ the axis along which t is
    shortest. It includes the disagreement among parts of the image, such as by moving shadows. It does not include errors that all matches
    share, such as a wrong camera matrix. Undetermined numbers have a standard deviation of a radian or more: the direction of t, if the
    camera only rotated or all points are far away. It is too small for fewer than 15 matches. Compare errors with confidenceLimit
@param reason if not null: why there is no pose, a sentence; empty if there is one
@param covariances N x 3, CV_32F or CV_64F, pixels^2: xx, xy and yy of the points, as refineMatches and propagateMatches return them. In the
    choice among poses, a match counts by 1 / sqrt(1 + xx + yy). Empty: all matches count alike
@return whether there is a pose, more significant than one of random matches or of matches displaced at random; if not, R, t and covariance
    are empty (NaN if their size is fixed)
@throws cv::Exception for points of a wrong type or of different numbers, points that are not finite, matrices that are
    not a camera's, covariances of another type or number, or a scale that is negative or not finite */
CV_EXPORTS_W bool findRelativePose(InputArray points1, InputArray points2, InputArray cameraMatrix1,
        InputArray cameraMatrix2, OutputArray R, OutputArray t, OutputArray inliers = noArray(),
        double scale = 0, OutputArray covariance = noArray(), CV_OUT String* reason = nullptr,
        InputArray covariances = noArray());

//! @}

}}  // namespace cv::iib

#endif
