// SPDX-License-Identifier: Apache-2.0
#ifndef OPENCV_IIB_VERDICT_HPP
#define OPENCV_IIB_VERDICT_HPP

#include "opencv2/core.hpp"

namespace cv {
namespace iib {

//! @addtogroup iib_geometry
//! @{

/** @brief Whether matches agree with a fundamental matrix or a homography by more than chance, such as those that
cv::findFundamentalMat and cv::findHomography call inliers.

The number of false alarms (@cite MoisanStival2004, section 3) is how many models that agree as well are expected among wrong
matches. It is counted in matches and in places, cells of a 32nd of the diagonal of what the points span, since matches beside
each other may be wrong together; the larger number counts. How often a wrong match agrees is what points that are anywhere would
do or, if that is more, what points of different matches do with the model of those that agree. findRelativePose and alignImages
take it for no more than chance above -3, one in a thousand.

@param points1, points2 the matches, right and wrong ones: N x 2, or N of two channels, CV_32F or CV_64F; pixels
@param inliers N x 1 or 1 x N, CV_8U: not 0 for matches that agree
@param epipolar whether they agree with a fundamental matrix, in place of a homography
@param threshold largest distance of a match that agrees from its epipolar line, or from where the homography has it,
    pixels of image 2
@return logarithm to base 10; infinite where the matches that agree are in no more places than tell a model: seven
    of a fundamental matrix, four of a homography
@throws cv::Exception for points of a wrong type, of different numbers or not finite, for marks of other numbers, and for a threshold
    that is not over 0 */
CV_EXPORTS_W double logFalseAlarms(
        InputArray points1, InputArray points2, InputArray inliers, bool epipolar, double threshold);

/** @brief How far off an estimate may be: the limit of the squared Mahalanobis distance error^T covariance^-1 error within which errors lie
with a given probability, under the covariances of findRelativePose, alignImages, refineMatches and Localizer.

The errors have longer tails than Gaussian ones: some estimates are wrong by more than their matches show. They follow Student's t with two
degrees of freedom, whose scale matrix is a quarter of the reported covariance. Compare a distance with this limit, not with a quantile of
chi-squared. doc/uncertainty.md counts errors inside the limit by kind of data.

@param probability 0 or more and below 1: the share of the errors
@param dimensions 1 or more: numbers in an error, such as 3 of a rotation, 2 of a direction or of a point
@throws cv::Exception (StsOutOfRange) for other values */
CV_EXPORTS_W double confidenceLimit(double probability, int dimensions);

//! @}

}  // namespace iib
}  // namespace cv

#endif
