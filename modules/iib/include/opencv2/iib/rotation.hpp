// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#ifndef OPENCV_IIB_ROTATION_HPP
#define OPENCV_IIB_ROTATION_HPP

#include "opencv2/iib/features.hpp"

namespace cv {
namespace iib {

//! @addtogroup iib
//! @{

/** @brief Angle by which most of the matched points of one image are rotated in another.

Angles of single keypoints change with the light, but a camera that turns moves all points by the same angle. So a
first matching, with IIBDescriptorExtractor::ORIENTATION_GRADIENT, is enough to find the angle between two images;
with it for all keypoints a second matching, with ORIENTATION_KEYPOINT, finds more:
@code
    for (KeyPoint& k : keypoints1) k.angle = 0;
    for (KeyPoint& k : keypoints2) k.angle = (float)estimateRotation(keypoints1, keypoints2, matches);
@endcode

Only the positions of the keypoints are used: the directions from one match to others vote for the angle, so that two
thirds of the matches may be wrong if those are scattered.

@param keypoints1, keypoints2 of the first and the second image.
@param matches1to2 queryIdx into keypoints1, trainIdx into keypoints2.
@return degrees, 0 <= angle < 360, in the sense of KeyPoint::angle (clockwise in the image): what points right in the first
image points there in the second.
@throws cv::Exception (StsOutOfRange) for indices without a keypoint, (StsBadArg) for matched keypoints whose positions are
NaN or infinite and if fewer than two matches differ in their positions in both images.
 */
CV_EXPORTS_W double estimateRotation(const std::vector<KeyPoint>& keypoints1,
        const std::vector<KeyPoint>& keypoints2, const std::vector<DMatch>& matches1to2);

//! @}

}  // namespace iib
}  // namespace cv

#endif
