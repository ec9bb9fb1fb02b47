// SPDX-License-Identifier: Apache-2.0
#ifndef OPENCV_IIB_VERDICT_HPP
#define OPENCV_IIB_VERDICT_HPP

#include "opencv2/core.hpp"

namespace cv { namespace iib {

//! @addtogroup iib_geometry
//! @{

/** @brief Whether the inliers of a fundamental matrix or a homography are significant, such as those of cv::findFundamentalMat and
cv::findHomography.

The number of false alarms (@cite MoisanStival2004, section 3) is the expected number of models that agree as well among wrong matches. It is counted
in matches and in places, and the larger number is returned: neighbouring matches may be wrong together. Places are cells of a 32nd of the diagonal of
what the points span. A wrong match agrees by the larger of two chances: of uniformly distributed points, and of pairs of points from different
matches. findRelativePose and alignImages need a logarithm below -3, one in a thousand.

@param points1, points2 all matches: N x 2, or N of two channels, CV_32F or CV_64F; pixels
@param inliers N x 1 or 1 x N, CV_8U: not 0 for matches that agree
@param epipolar whether they agree with a fundamental matrix, in place of a homography
@param threshold largest distance of an inlier from its epipolar line, or from its place by the homography, pixels of image 2
@return logarithm to base 10; infinite if the inliers are in no more places than determine a model: seven for a fundamental matrix, four for a
    homography
@throws cv::Exception for points of a wrong type, of different numbers or not finite, for a different number of inliers' marks, and for a threshold
    that is not over 0 */
CV_EXPORTS_W double logFalseAlarms(
        InputArray points1, InputArray points2, InputArray inliers, bool epipolar, double threshold);

/** @brief Limit of the squared Mahalanobis distance, error^T covariance^-1 error.

Errors stay below it with the given probability. For covariances of findRelativePose, alignImages, refineMatches and Localizer.

The errors have longer tails than Gaussian ones, since some estimates are worse than their matches show. They follow Student's t with two degrees of
freedom whose scale matrix is a quarter of the covariance. Compare a distance with this limit, not with a quantile of chi-squared. doc/uncertainty.md
counts errors inside the limits by kind of data.

@param probability share of the errors, 0 or more and below 1
@param dimensions 1 or more: numbers in an error, such as 3 of a rotation, 2 of a direction or of a point
@throws cv::Exception (StsOutOfRange) for other values */
CV_EXPORTS_W double confidenceLimit(double probability, int dimensions);

//! @}

}}  // namespace cv::iib

#endif
