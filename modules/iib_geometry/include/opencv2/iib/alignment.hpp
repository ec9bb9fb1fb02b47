// SPDX-License-Identifier: Apache-2.0
#ifndef OPENCV_IIB_ALIGNMENT_HPP
#define OPENCV_IIB_ALIGNMENT_HPP

#include "opencv2/core.hpp"

namespace cv {
namespace iib {

//! @addtogroup iib_geometry
//! @{

//! Transforms between two images, each with more freedom than the one before; see alignImages.
enum AlignmentModel
{
    ALIGN_TRANSLATION,
    ALIGN_SIMILARITY,  //!< and rotation and scale
    ALIGN_AFFINE,      //!< and shear
    ALIGN_HOMOGRAPHY   //!< and perspective: a plane, or any scene from one place
};

/** @brief Aligns an image with a reference that was taken in another light: finds where its pixels lie in the reference.

For images of a plane, or of anything by a camera that stays where it is, though it may turn and zoom, by day and by night.
Images from two places of a scene that is not flat have no such transform; findRelativePose is for them. Points are detected
in both images and matched, in a second attempt also by images that are turned by any angle (matchRotated); the matches are
refined (refineMatches), and the transform that most of them agree with is fitted to them by Levenberg-Marquardt under
Cauchy's loss, cut off at three scales of half a pixel. The same input gives the same answer, whatever the number of threads.

    cv::Mat transform, aligned;
    if (cv::iib::alignImages(reference, image, transform))
        cv::warpPerspective(image, aligned, transform, reference.size());

@param reference, image of any size, of the types that IIBDescriptorExtractor::compute takes
@param transform 3 x 3, CV_64F, last entry 1: from pixels of the image to pixels of the reference
@param model AlignmentModel; the simplest one that is true of the images gives the smallest errors
@param error 4 x 1, CV_64F, pixels of the reference: standard deviations of the places of the image's corners (top left,
    top right, bottom right, bottom left), as the matches around the transform tell them. What all matches have in common,
    such as the parallax of a scene that is not flat, is not in it.
@param matches N x 4, CV_32F: the matches that agree with the transform, x and y in the reference, x and y in the image,
    pixels; where the answer is false, those that agreed best
@return false, with transform and error empty, if too few matches agree for the images to show the same, which are fewer
    than 16 or than one in twenty, or if a corner's deviation is over 2 pixels, as where they share
    nothing but a logo; also for images without points
@throws cv::Exception for an unknown model, and as IIBDescriptorExtractor::compute for images */
CV_EXPORTS_W bool alignImages(InputArray reference, InputArray image, OutputArray transform,
        int model = ALIGN_HOMOGRAPHY, OutputArray error = noArray(), OutputArray matches = noArray());

//! @}

}  // namespace iib
}  // namespace cv

#endif
