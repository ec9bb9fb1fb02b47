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

Only the positions of the keypoints are used. The directions from one match to others vote for the angle, so two thirds of
the matches may be wrong if they are scattered. matchRotated matches two images from the start.

@param keypoints1, keypoints2 of the first and the second image.
@param matches1to2 queryIdx into keypoints1, trainIdx into keypoints2.
@return degrees, 0 <= angle < 360, clockwise in the image as KeyPoint::angle, from the first image to the second.
@throws cv::Exception (StsOutOfRange) for indices without a keypoint, (StsBadArg) for matched keypoints whose positions
are NaN or infinite, and for fewer than two matches with different positions.
 */
CV_EXPORTS_W double estimateRotation(const std::vector<KeyPoint>& keypoints1,
        const std::vector<KeyPoint>& keypoints2, const std::vector<DMatch>& matches1to2);

/** @brief Matches two images of which one may be rotated in the image plane, and finds the angle.

Angles of single keypoints change with the illumination, but a camera rotation is the same for all keypoints. First the
200 strongest keypoints of each image are described at half the resolution, at three angles in the first image and four in the
second, whose differences are all multiples of 30 degrees. Of each mutual matching, every two matches whose distance
changes like KeyPoint::size vote for the angle between their directions. Then all keypoints are described with the angle
that has most votes, and matched. For upright cameras, matching without this is as good and takes half the time.

@param image1, image2 as in IIBDescriptorExtractor::compute.
@param keypoints1, keypoints2 of the first and the second image. Their order is kept; only
IIBDescriptorExtractor::BORDER_DROP removes any. Each KeyPoint::angle is set to the angle of its description: -1 in the first
image; in the second the rotation, or -1 for a rotation within 3 degrees of 0.
@param extractor with IIBDescriptorExtractor::ORIENTATION_KEYPOINT and without extra channels;
IIBDescriptorExtractor::PRESET_UNIVERSAL is best.
@param matcher for binary descriptors of any width, such as HierarchicalMatcher with cross-check and ratio 0.92;
descriptors that were added to it are not used.
@param matches1to2 queryIdx into keypoints1, trainIdx into keypoints2; empty if an image is, or has no keypoints.
@param rotation -1 to find it, or the known rotation (from an IMU or from EXIF data), 0 <= rotation < 360, with the
direction of the result.
@return degrees, 0 <= rotation < 360, clockwise in the image, as estimateRotation; 0 where no matches agree.
@throws cv::Exception (StsNullPtr) without extractor or matcher, (StsBadArg) for another orientation, (StsOutOfRange)
for another rotation, and as IIBDescriptorExtractor::compute. Keypoints and matches then stay as they were.
 */
CV_EXPORTS_W double matchRotated(InputArray image1, CV_OUT CV_IN_OUT std::vector<KeyPoint>& keypoints1,
        InputArray image2, CV_OUT CV_IN_OUT std::vector<KeyPoint>& keypoints2,
        const Ptr<IIBDescriptorExtractor>& extractor, const Ptr<DescriptorMatcher>& matcher,
        CV_OUT std::vector<DMatch>& matches1to2, double rotation = -1);
/** @overload
With the keypoints of the extractor's detector. */
CV_EXPORTS_W double matchRotated(InputArray image1, InputArray image2,
        const Ptr<IIBDescriptorExtractor>& extractor, const Ptr<DescriptorMatcher>& matcher,
        CV_OUT std::vector<KeyPoint>& keypoints1, CV_OUT std::vector<KeyPoint>& keypoints2,
        CV_OUT std::vector<DMatch>& matches1to2, double rotation = -1);

//! @}

}}  // namespace cv::iib

#endif
