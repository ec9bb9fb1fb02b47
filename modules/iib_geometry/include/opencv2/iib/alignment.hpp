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
    ALIGN_HOMOGRAPHY,  //!< and perspective: a plane, or any scene from one place
    ALIGN_AUTO         //!< the simplest of them that is true of the images
};

/** @brief Aligns an image with a reference that was taken in another light: finds where its pixels lie in the reference.

For images of a plane, or of anything by a camera that stays where it is, though it may turn and zoom, by day and by night.
Images from two places of a scene that is not flat have no such transform; findRelativePose is for them. Points are detected
in both images and matched, where that fails also by images that are turned by any angle (matchRotated, for all models but
ALIGN_TRANSLATION); the matches are refined (refineMatches), and the transform that most of them agree with is fitted to them as
findRelativePose fits a pose. Images whose longer side has more than 1024 pixels are reduced for that, and in a second attempt those of
more than 512 to 512 pixels, where blurred ones are sharper; the matches that agree are then refined at full size, where the images are
sharp enough for it. The same input gives the same answer, whatever the number of threads.

There is no transform, and `reason` says which of these it was, where
- the matches that agree are not significant (the number of false alarms, as of findRelativePose);
- a transform of more freedom agrees better with the matches than noise would let it;
- the camera moved through a scene with depth (parallax): matches in other places lie beside the transform along lines through one point;
- the images are equal to the pixel in some parts and differ in the others, as by captions, a frame or a part of a vehicle;
- the matches are single pixels that do not move, as hot pixels;
- the matches lie in small parts alone, as of a logo: neither all over what both images show nor in one place, which is a connected group of
  15 of 192 cells with 80 matches;
- the errors of the corners are more than a quarter of the image's diagonal.

The verdict and its limits do not depend on the images' sizes. Where a part moved otherwise, or only one part agrees, the transform is that
of the larger part, and `note` says so. How often the verdict errs is on the page of uncertainties.

    cv::Mat transform, aligned;
    if (cv::iib::alignImages(reference, image, transform))
        cv::warpPerspective(image, aligned, transform, reference.size());

@param reference, image of any size, of the types that IIBDescriptorExtractor::compute takes
@param transform 3 x 3, CV_64F, last entry 1: from pixels of the image to pixels of the reference
@param model AlignmentModel; the simplest one that is true of the images gives the smallest errors, one that is not is refused. ALIGN_AUTO chooses
    that one by the likelihood of the matches' errors (compare Torr 1998); where a part of the images moved, that of the part that stayed
@param error 4 x 1, CV_64F, pixels of the reference: standard deviations of the places of the image's corners (top left,
    top right, bottom right, bottom left), each of a length, the root of both coordinates' variances together. They are estimated from the
    matches' noise, from how much parts of the image disagree, and from the resampling of patches; they are large for corners far from the matches.
    Where a quarter as many places as agree lie beside the transform by less than parallax, their distance is part of the error
@param matches N x 4, CV_32F: the matches that agree with the transform, x and y in the reference, x and y in the image,
    pixels; where the answer is false, those that agreed best
@param reason if not null: why there is no transform, a sentence; empty if there is one
@param referenceMask, mask CV_8UC1 of the size of the reference and of the image, 0 where no points are to be found; empty: everywhere
@param simplest if not null: the AlignmentModel of least freedom that explains the matches as well, which is that of the transform if `model` is
    ALIGN_AUTO; -1 where there is no transform
@param note if not null: a sentence about a transform that was found, such as that a simpler model is as true, that a part moved
    otherwise, or that the images agree in one part alone; mostly empty
@return false, with transform and error empty (NaN where their size is fixed), if there is none
@throws cv::Exception for an unknown model, and as IIBDescriptorExtractor::compute for images */
CV_EXPORTS_W bool alignImages(InputArray reference, InputArray image, OutputArray transform,
        int model = ALIGN_HOMOGRAPHY, OutputArray error = noArray(), OutputArray matches = noArray(),
        CV_OUT String* reason = nullptr, InputArray referenceMask = noArray(), InputArray mask = noArray(),
        CV_OUT int* simplest = nullptr, CV_OUT String* note = nullptr);

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
            OutputArray matches = noArray(), CV_OUT String* reason = nullptr, InputArray mask = noArray(),
            CV_OUT int* simplest = nullptr, CV_OUT String* note = nullptr) const = 0;
};

//! @}

}  // namespace iib
}  // namespace cv

#endif
