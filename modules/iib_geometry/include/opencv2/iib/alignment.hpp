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
in both images and matched, where that fails also by images that are turned by any angle (matchRotated, for all models but
ALIGN_TRANSLATION); the matches are refined (refineMatches), and the transform that most of them agree with is fitted to them as
findRelativePose fits a pose. Images whose longer side has more than 1024 pixels are reduced for that, and in a second attempt those of
more than 512 to 512 pixels, where blurred ones are sharper; the matches that agree are then refined at full size, where the images are
sharp enough for it. The same input gives the same answer, whatever the number of threads.

There is no transform, and `reason` says which of these it was,
- where the matches that agree are no more than chance (the number of false alarms, as of findRelativePose);
- where they span less than 12 % of what has points in the image that has them over less of what both show (one may be masked, or black
  elsewhere), or 5 % of all that both show and masks allow, once the outermost matches, as many as determine the transform
  (1 to 4), are left out, as a logo or a caption that both hold; or where they lie in fewer than a third of the cells (of 8 x 8) in which as many
  of the points would be, as of two captions;
- where a transform of more freedom agrees better with the matches than noise would let it, by the likelihood of their errors, at
  the size at which they are matched, or at full size;
- where a quarter as many places as agree lie beside the transform along lines through one point, by more than 6 pixels of the size at
  which they are matched (24 of an image of 4096): the camera moved (parallax), or shadows did. By less, `error` has it.

How often it errs, in the pairs that its limits were chosen on (iib_evaluation --only alignment): of 519 pairs of unrelated pictures none is
found by any model, nor of 36 that share a logo of 100 pixels; of 104 photographs in other light, the second one moved by a homography, 101
are found, and by models of less freedom than what moved them 9 of 777; by models that are true 1119 of 1143 of cameras that stood still, some of
which the wind moved. Two of 21 pairs under other lamps are refused for the way in which shadows moved.

    cv::Mat transform, aligned;
    if (cv::iib::alignImages(reference, image, transform))
        cv::warpPerspective(image, aligned, transform, reference.size());

@param reference, image of any size, of the types that IIBDescriptorExtractor::compute takes
@param transform 3 x 3, CV_64F, last entry 1: from pixels of the image to pixels of the reference
@param model AlignmentModel; the simplest one that is true of the images gives the smallest errors, one that is not is refused
@param error 4 x 1, CV_64F, pixels of the reference: standard deviations of the places of the image's corners (top left,
    top right, bottom right, bottom left), each of a length, the root of both coordinates' variances together, as parts of the image tell
    them; large for corners far from what both images show. Of what all matches have in common .4 of the matches' deviation is in it, which
    other lamps show. Where a quarter as many places as agree lie beside the transform as above, but by less, their distance from it is in
    it as well
@param matches N x 4, CV_32F: the matches that agree with the transform, x and y in the reference, x and y in the image,
    pixels; where the answer is false, those that agreed best
@param reason if not null: why there is no transform, a sentence; empty if there is one
@param referenceMask, mask CV_8UC1 of the size of the reference and of the image, 0 where no points are to be found; empty: everywhere
@return false, with transform and error empty (NaN where their size is fixed), if there is none
@throws cv::Exception for an unknown model, and as IIBDescriptorExtractor::compute for images */
CV_EXPORTS_W bool alignImages(InputArray reference, InputArray image, OutputArray transform,
        int model = ALIGN_HOMOGRAPHY, OutputArray error = noArray(), OutputArray matches = noArray(),
        CV_OUT String* reason = nullptr, InputArray referenceMask = noArray(), InputArray mask = noArray());

/** @brief Aligns many images with one reference as alignImages does, and describes the reference once.

The reference is not copied; its pixels must stay. Threads may share one. */
class CV_EXPORTS_W ImageAligner
{
public:
    /** @param reference, model as in alignImages
    @param mask CV_8UC1 of the reference's size, 0 where no points are to be found; empty: everywhere */
    CV_WRAP static Ptr<ImageAligner> create(
            InputArray reference, int model = ALIGN_HOMOGRAPHY, InputArray mask = noArray());

    virtual ~ImageAligner() {}

    //! As alignImages; `mask` is that of the image.
    CV_WRAP virtual bool align(InputArray image, OutputArray transform, OutputArray error = noArray(),
            OutputArray matches = noArray(), CV_OUT String* reason = nullptr,
            InputArray mask = noArray()) const = 0;
};

//! @}

}  // namespace iib
}  // namespace cv

#endif
