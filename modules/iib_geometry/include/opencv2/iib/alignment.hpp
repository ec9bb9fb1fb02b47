// SPDX-License-Identifier: Apache-2.0
#ifndef OPENCV_IIB_ALIGNMENT_HPP
#define OPENCV_IIB_ALIGNMENT_HPP

#include "opencv2/core.hpp"

namespace cv { namespace iib {

//! @addtogroup iib_geometry
//! @{

//! Transforms between two images, each with more freedom than the one before; see alignImages.
enum AlignmentModel
{
    ALIGN_TRANSLATION,
    ALIGN_SIMILARITY,  //!< and rotation and scale
    ALIGN_AFFINE,      //!< and shear
    ALIGN_HOMOGRAPHY,  //!< and perspective: a plane, or any scene from one place
    ALIGN_AUTO         //!< the simplest of these that is true of the images
};

/** @brief Estimates the transform from an image to a reference under changed illumination.

It is for images of a plane, and for any scene by a camera that does not move; it may rotate and zoom. Images of a scene with depth from two
places have no such transform: use findRelativePose.

Points are detected in both images, matched and refined (refineMatches), and a transform is fitted to most of the matches. If that fails, views of
images that are rotated, zoomed or tilted against each other are searched (as in matchViews, for all models but ALIGN_TRANSLATION). The search also
finds a small image in a part of a large one. Images of more than 1024 pixels are reduced for matching; after a search only their common parts count. A
second attempt reduces images of more than 512 pixels to 512, where blurred images are sharper. The matches that agree are then refined at full
size, if the images are sharp there. The result does not depend on the number of threads.

There is no transform, and `reason` says why, where
- the matches that agree are not significant (logFalseAlarms), which may be because most of an image is black or white;
- a model of more freedom agrees significantly better;
- the camera moved through a scene with depth (parallax): matches in other places lie beside the transform, along lines through one point;
- the images are equal to the pixel in some parts and differ in the others, such as captions, a frame or a part of a vehicle;
- many matches are marks of a few pixels that do not move, such as hot pixels or dust, while larger points moved;
- the matches lie in small parts alone, such as a logo or a narrow overlap: neither all over the part that both images show, nor in one place. A place is
  a connected group of 15 of 192 cells with 80 matches, which span .045 of each image;
- the standard deviation of a corner is more than a quarter of the image's diagonal.

The verdict does not depend on the images' sizes. Where a part moved otherwise, or only one part agrees, the transform is that of the larger part, and
`note` says so. doc/uncertainty.md counts errors by kind of data.

    cv::Mat transform, aligned;
    if (cv::iib::alignImages(reference, image, transform))
        cv::warpPerspective(image, aligned, transform, reference.size());

@param reference, image of any size, of the types that IIBDescriptorExtractor::compute takes
@param transform 3 x 3, CV_64F, last entry 1: from pixels of the image to pixels of the reference
@param model AlignmentModel. The simplest true model gives the smallest errors; an untrue one is refused. ALIGN_AUTO chooses the simplest true model by
    the likelihood of the matches' errors (compare Torr 1998), or that of the static part if a part of the scene moved
@param error 4 x 1, CV_64F, pixels of the reference: standard deviations of the image's corners (top left, top right, bottom right, bottom left), each
    the root of both coordinates' variances together. They include the matches' noise, disagreement among parts of the image, and resampling of patches.
    They include the displacement of a part beside the transform, such as moved shadows or depth, if it has an eighth as many places as agree
@param matches N x 4, CV_32F: the matches that agree with the transform, or with the best refused one: x and y in the reference, x and y in the image,
    pixels
@param reason if not null: why there is no transform, a sentence; empty if there is one
@param referenceMask, mask CV_8UC1 of the size of the reference and of the image, 0 where no points are to be detected; empty: everywhere
@param simplest if not null: the AlignmentModel of least freedom that explains the matches as well; -1 if there is no transform
@param note if not null: a sentence about a transform that was found, such as that a simpler model is as true, that a part moved otherwise, or
    that the images agree in one part alone; mostly empty
@return whether there is a transform; if not, transform and error are empty (NaN if their size is fixed)
@throws cv::Exception for an unknown model, and as IIBDescriptorExtractor::compute for images */
CV_EXPORTS_W bool alignImages(InputArray reference, InputArray image, OutputArray transform,
        int model = ALIGN_HOMOGRAPHY, OutputArray error = noArray(), OutputArray matches = noArray(),
        CV_OUT String* reason = nullptr, InputArray referenceMask = noArray(), InputArray mask = noArray(),
        CV_OUT int* simplest = nullptr, CV_OUT String* note = nullptr);

/** @brief Aligns many images with one reference as alignImages does, and describes the reference once.

The reference is not copied; its pixels must not change. Threads may share one aligner. */
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

}}  // namespace cv::iib

#endif
