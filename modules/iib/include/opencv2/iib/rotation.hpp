// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#ifndef OPENCV_IIB_ROTATION_HPP
#define OPENCV_IIB_ROTATION_HPP

#include "opencv2/iib/descriptor.hpp"

namespace cv { namespace iib {

//! @addtogroup iib
//! @{

/** @brief Angle by which most of the matched points of one image are rotated in another.

Only the positions of the keypoints are used: the directions from one match to others vote for the angle, so that two
thirds of the matches may be wrong if those are scattered. To match two images from the start take matchRotated.

@param keypoints1, keypoints2 of the first and the second image.
@param matches1to2 queryIdx into keypoints1, trainIdx into keypoints2.
@return degrees, 0 <= angle < 360, in the sense of KeyPoint::angle (clockwise in the image): what points right in the
first image points there in the second.
@throws cv::Exception (StsOutOfRange) for indices without a keypoint, (StsBadArg) for matched keypoints whose positions
are NaN or infinite and if fewer than two matches differ in their positions in both images.
 */
CV_EXPORTS_W double estimateRotation(const std::vector<KeyPoint>& keypoints1,
        const std::vector<KeyPoint>& keypoints2, const std::vector<DMatch>& matches1to2);

/** @brief Matches two images of which one may be rotated in the image plane, and finds the angle.

Angles of single keypoints change with the light, but a camera that turns moves all keypoints by the same angle. First
the 200 strongest keypoints of each image are described at half the resolution, at three angles in the first image and
at four in the second, so that they differ by all multiples of 30 degrees. Of each mutual matching, every two matches
whose distance changes as KeyPoint::size does vote for the angle between their directions, 0 as any other. Then all
keypoints are described with the one angle that most vote for, and matched. Where cameras do not turn at all a match
without this is as good and takes half the time.

@param image1, image2 as in IIBDescriptorExtractor::compute.
@param keypoints1, keypoints2 of the first and the second image. Their order is kept; none is removed but by
IIBDescriptorExtractor::BORDER_DROP. Each KeyPoint::angle is set to what it was described with: -1 in the first image,
and in the second the rotation, or -1 if that is within 3 degrees of 0.
@param extractor with IIBDescriptorExtractor::ORIENTATION_KEYPOINT and without extra channels;
IIBDescriptorExtractor::PRESET_UNIVERSAL is the best for it.
@param matcher for binary descriptors of any width, such as HierarchicalMatcher with cross-check and ratio 0.9;
descriptors that were added to it are not used.
@param matches1to2 queryIdx into keypoints1, trainIdx into keypoints2; empty if an image is, or has no keypoints.
@param rotation -1 to find it, or the rotation in degrees where it is known (from an IMU or from EXIF data): it must be
in the sense that is returned, 0 or more and less than 360. Then there is nothing to find, and no time lost.
@return degrees, 0 <= rotation < 360, clockwise in the image, as estimateRotation; 0 where no matches agree.
@throws cv::Exception (StsNullPtr) without extractor or matcher, (StsBadArg) for another orientation, (StsOutOfRange)
for another rotation, and as IIBDescriptorExtractor::compute. Keypoints and matches then stay as they were.
 */
CV_EXPORTS_W double matchRotated(InputArray image1, CV_OUT CV_IN_OUT std::vector<KeyPoint>& keypoints1,
        InputArray image2, CV_OUT CV_IN_OUT std::vector<KeyPoint>& keypoints2,
        const Ptr<IIBDescriptorExtractor>& extractor, const Ptr<DescriptorMatcher>& matcher,
        CV_OUT std::vector<DMatch>& matches1to2, double rotation = -1);
/** @overload
With the keypoints that the extractor's detector finds: like all results, they come after what is given. */
CV_EXPORTS_W double matchRotated(InputArray image1, InputArray image2,
        const Ptr<IIBDescriptorExtractor>& extractor, const Ptr<DescriptorMatcher>& matcher,
        CV_OUT std::vector<KeyPoint>& keypoints1, CV_OUT std::vector<KeyPoint>& keypoints2,
        CV_OUT std::vector<DMatch>& matches1to2, double rotation = -1);

//! @}

}}  // namespace cv::iib

#endif
