// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#ifndef OPENCV_IIB_REFINEMENT_HPP
#define OPENCV_IIB_REFINEMENT_HPP

#include "opencv2/iib/features.hpp"

namespace cv { namespace iib {

//! @addtogroup iib
//! @{

/** @brief Moves the second point of each match to where the surroundings of both points agree best, and tells how sure
that is: least-squares matching, to a tenth of a pixel and better, also where the light changed.

Both images are normalized locally. The patch around the point of the first image, about 30 pixels wide, stays where it
is. It is laid onto the second image, turned and scaled as the keypoints' angles and sizes say, and moved and deformed
(six parameters of an affine transform, besides contrast and brightness) until the squared differences are least: the
adjustment of
@cite Foerstner1982 and @cite Gruen1985, solved with the matrix of the first patch alone, as the inverse compositional
algorithm of @cite BakerMatthews2004 does. A match is refused where that moves its point by 2 pixels or more, or where
the patches do not agree well enough after it, or no better than before and ten steps do not settle it: then it stays as
it was detected. A point that was right before stays, and is the surest.

@param image1, image2 as in IIBDescriptorExtractor::compute.
@param keypoints1, keypoints2 of the first and the second image. Only the difference of their angles counts, as only the
ratio of the sizes does; -1 is upright, 0, where the other keypoint has an angle, as after matchRotated. Where neither has
one, patches are laid upright and, if most of the given matches lie as in an image that is turned by 10 degrees or more,
turned so: whichever agrees better.
@param matches1to2 queryIdx into keypoints1, trainIdx into keypoints2.
@param points1 N x 2, CV_32F, a row for each match, in pixels: the first points, as they were detected.
@param points2 N x 2, CV_32F, in pixels: the second points, refined, or as they were detected where that was refused.
@param covariances N x 3, CV_32F: xx, xy and yy of points2 given points1, in squared pixels, from the differences that
remain and from how far these agree among neighbouring samples; never 0. Of refused matches 1, 0 and 1. Along a straight
edge the standard deviation is a pixel or more. Errors that all matches of a pair share are not in it: a camera that moved
by a tenth of a pixel, light that moved every shadow. The documentation's page "How sure" counts how often they hold.
@param similarities N x 1, CV_32F: the correlation of the two patches where they agree best, above 0.5 up to 1; -1 where
the match was refused.
@throws cv::Exception (StsOutOfRange) for indices without a keypoint, (StsBadArg) for an empty image, and as
IIBDescriptorExtractor::compute for images and keypoints. Without matches all outputs are empty. Outputs may also be
vectors whose elements are rows, as std::vector<Point2f> and std::vector<Vec3d>.
 */
CV_EXPORTS_W void refineMatches(InputArray image1, const std::vector<KeyPoint>& keypoints1, InputArray image2,
        const std::vector<KeyPoint>& keypoints2, const std::vector<DMatch>& matches1to2, OutputArray points1,
        OutputArray points2, OutputArray covariances = noArray(), OutputArray similarities = noArray());

/** @brief Refines matches as refineMatches does and adds further ones that these lead to: match propagation
@cite LhuillierQuan2002.

A refined match tells where the surroundings of its point are in the second image. A keypoint without a match is tried
where the nearest refined match, less than 100 pixels away, says it should be: with the keypoints of the second image
within 3 pixels and a tenth of the distance, four of them, and four times at most, from new matches. What agrees best
after least-squares matching is taken, and leads on. Only matches that two of the eight nearest ones confirm lead to
others. For poses from views that are far apart or in other
light: half as many right matches again, and poses that were not found without them. Where a pattern repeats, as the
windows of a block of flats do, wrong matches that confirm each other lead to further ones as well. So for a pose call
it twice, with all matches and with those alone that agree with a first pose, and take the pose of the two that more
matches agree with under one scale, such as .25 pixels: under scales of their own the less exact pose may have more.

@param image1, image2, keypoints1, keypoints2 as in refineMatches; of any detector.
@param matches1to2 on return the same matches, followed by those that were found, the most similar ones of each round
first. Their distance is that of an empty cv::DMatch, the largest number, as no descriptors were compared; no keypoint
of theirs is in another match.
@param points1, points2, covariances, similarities as in refineMatches, a row for each match on return. Those that
were found have similarities above 0.7.
@throws cv::Exception as refineMatches. Without matches there is nothing to propagate, and all outputs are empty.
 */
CV_EXPORTS_W void propagateMatches(InputArray image1, const std::vector<KeyPoint>& keypoints1,
        InputArray image2, const std::vector<KeyPoint>& keypoints2,
        CV_IN_OUT std::vector<DMatch>& matches1to2, OutputArray points1, OutputArray points2,
        OutputArray covariances = noArray(), OutputArray similarities = noArray());

//! @}

}}  // namespace cv::iib

#endif
