// SPDX-License-Identifier: Apache-2.0
#ifndef OPENCV_IIB_VIEWS_HPP
#define OPENCV_IIB_VIEWS_HPP

#include "opencv2/core.hpp"

namespace cv { namespace iib {

//! @addtogroup iib_geometry
//! @{

/** @brief Matches two images under changed illumination: at any rotation, tilted, from a quarter to four times the size.

First the images themselves are matched: the recommended chain, then propagateMatches. Decisive matches are returned.
Otherwise views of both images are simulated (@cite MorelYu2009) and compared by a few hundred points each:
- either image reduced by up to 4, at rotations 30 degrees apart;
- either image tilted by 2 (with maxTilt above 4 also by 4), upright, reduced and rotated.

Views in which neighbouring matches agree give an affine map between the images. The images are matched again in its
views, with all points of the common part. The pair of views with the fewest false alarms (logFalseAlarms, of a
fundamental matrix or a homography) wins. If many of its matches are outliers, the inliers alone are propagated again.

The result is significant if fewer than one in a thousand such results is expected among random matches, over all pairs
of views that were compared. It does not depend on the number of threads.

Cost: without a search, the time of detection, description, matching and propagation. A search takes 2 to 15 times as
long with 1000 points, and 30 times as long if it finds nothing.

Limits:
- Images of more than 640 pixels are reduced to 640 for the search, and their common parts to 1024 for matching after
  it. Covariances are those of the reduced images, in pixels of the originals.
- An image of more than 960 pixels and more than 1.5 times the other's longer side is searched in all its parts first.
  Both then have pixels of about the same size, up to 4096 on the longer side. The search takes time in
  proportion to the pixels.
- Views are affine: in a scene with strong perspective one part alone may match.
- Mirrored images are not searched for, but a symmetric picture may match its mirror image.

@param image1, image2 as in IIBDescriptorExtractor::compute
@param points1, points2 N x 2, CV_32F, pixels: matched points of both images; the best ones if the result is false
@param covariances N x 3, CV_32F: xx, xy and yy of points2 given points1, squared pixels, as refineMatches
@param similarities N x 1, CV_32F, as refineMatches
@param view 3 x 3, CV_64F: approximate affine map from pixels of image 1 to those of image 2; empty if false
@param maxFeatures largest number of keypoints of each image; 0 keeps all
@param maxTilt largest tilt to search for, 1 to 8: the factor by which one axis is shortened. Up to 2, no view is tilted
@param mask1, mask2 CV_8UC1 of the size of their image, 0 where no keypoints are wanted
@param reason if not null, receives a sentence that says why the result is false; empty if it is true
@return whether the matches that agree with one geometry are significant
@throws cv::Exception (StsOutOfRange) for another maxTilt or maxFeatures, (StsBadArg) for masks of another size or type,
    and as IIBDescriptorExtractor::compute for images */
CV_EXPORTS_W bool matchViews(InputArray image1, InputArray image2, OutputArray points1, OutputArray points2,
        OutputArray covariances = noArray(), OutputArray similarities = noArray(),
        OutputArray view = noArray(), int maxFeatures = 4000, double maxTilt = 4,
        InputArray mask1 = noArray(), InputArray mask2 = noArray(), CV_OUT String* reason = nullptr);

/** @brief Matches one image with many others as matchViews does, but computes its views once.

The image is not copied; its pixels must stay valid. Threads may share one object. */
class CV_EXPORTS_W ViewMatcher
{
public:
    //! @param image1, maxFeatures, maxTilt, mask1 as in matchViews
    CV_WRAP static Ptr<ViewMatcher> create(
            InputArray image1, int maxFeatures = 4000, double maxTilt = 4, InputArray mask1 = noArray());

    virtual ~ViewMatcher() {}

    //! As matchViews.
    CV_WRAP virtual bool match(InputArray image2, OutputArray points1, OutputArray points2,
            OutputArray covariances = noArray(), OutputArray similarities = noArray(),
            OutputArray view = noArray(), InputArray mask2 = noArray(),
            CV_OUT String* reason = nullptr) const = 0;
};

//! @}

}}  // namespace cv::iib

#endif
