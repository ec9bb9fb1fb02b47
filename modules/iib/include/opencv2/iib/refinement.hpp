// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#ifndef OPENCV_IIB_REFINEMENT_HPP
#define OPENCV_IIB_REFINEMENT_HPP

#include "opencv2/iib/features.hpp"

namespace cv { namespace iib {

//! @addtogroup iib
//! @{

/** @brief Moves the second point of each match to where the surroundings of both points agree best, and estimates the
covariance of its place: least-squares matching, to a tenth of a pixel and better, also under changed illumination.

Both images are normalized locally. The patch around the first point, about 30 pixels wide, stays fixed. It is placed on the
second image, rotated and scaled by the keypoints' angles and sizes. Then six affine parameters, contrast and brightness
are changed until the squared differences are least: the adjustment of @cite Foerstner1982 and @cite Gruen1985, solved
by the inverse compositional algorithm of @cite BakerMatthews2004.

A match is refused, and its point stays as detected, if
- its point moves by 2 pixels or more;
- the patches correlate by 0.5 or less at the end;
- ten steps neither converge nor raise the correlation.

@param image1, image2 as in IIBDescriptorExtractor::compute.
@param keypoints1, keypoints2 of the first and the second image. Only the difference of their angles and the ratio of their
sizes are used. An angle of -1 means 0 if the other keypoint has an angle, as after matchRotated. If neither has one, the
patch starts upright; if the given matches are rotated by 10 degrees or more, also by this angle, and the better start is
used.
@param matches1to2 queryIdx into keypoints1, trainIdx into keypoints2.
@param points1 N x 2, CV_32F, a row for each match, in pixels: the first points, as detected.
@param points2 N x 2, CV_32F, in pixels: the second points, refined, or as detected for refused matches.
@param covariances N x 3, CV_32F: xx, xy and yy of points2 given points1, in squared pixels, estimated from the residuals
and their correlation among neighbouring samples; never 0. For refused matches 1, 0 and 1. Along a straight edge the standard
deviation is a pixel or more. Errors that all matches of a pair share are not included. The documentation's page "How sure"
measures how often the covariances hold.
@param similarities N x 1, CV_32F: the correlation of the two patches, above 0.5 up to 1; -1 for refused matches.
@throws cv::Exception (StsOutOfRange) for indices without a keypoint, (StsBadArg) for an empty image, and as
IIBDescriptorExtractor::compute for images and keypoints. Without matches all outputs are empty. Outputs may also be
vectors whose elements are rows, as std::vector<Point2f> and std::vector<Vec3d>.
 */
CV_EXPORTS_W void refineMatches(InputArray image1, const std::vector<KeyPoint>& keypoints1, InputArray image2,
        const std::vector<KeyPoint>& keypoints2, const std::vector<DMatch>& matches1to2, OutputArray points1,
        OutputArray points2, OutputArray covariances = noArray(), OutputArray similarities = noArray());

/** @brief Refines matches as refineMatches does, and adds further matches that they predict: match propagation
@cite LhuillierQuan2002.

A refined match predicts the places of keypoints less than 100 pixels from it. A keypoint without a match is compared with up
to four keypoints of the second image within 3 pixels and a tenth of the distance from its predicted place. Up to four times,
new matches give another prediction. The best result of least-squares matching is added, and predicts further ones. Only
matches that at least two of their eight nearest neighbours confirm predict others.

This adds about half as many correct matches for views that are far apart or under changed illumination. In repeated patterns,
wrong matches may confirm each other. For a pose, call it twice: with all matches, and with the inliers of a first pose.
Use the pose with more inliers under one fixed scale, such as .25 pixels.

@param image1, image2, keypoints1, keypoints2 as in refineMatches; of any detector.
@param matches1to2 on return the same matches, followed by the new ones, the most similar of each round first. Their
distance is the largest float, as in an empty cv::DMatch, since no descriptors are compared. No keypoint of a new match is
in another match.
@param points1, points2, covariances, similarities as in refineMatches, a row for each match on return. New matches have
similarities above 0.7.
@throws cv::Exception as refineMatches. Without matches all outputs are empty.
 */
CV_EXPORTS_W void propagateMatches(InputArray image1, const std::vector<KeyPoint>& keypoints1,
        InputArray image2, const std::vector<KeyPoint>& keypoints2,
        CV_IN_OUT std::vector<DMatch>& matches1to2, OutputArray points1, OutputArray points2,
        OutputArray covariances = noArray(), OutputArray similarities = noArray());

//! @}

}}  // namespace cv::iib

#endif
