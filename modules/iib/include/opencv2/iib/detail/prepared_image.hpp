// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#ifndef OPENCV_IIB_DETAIL_PREPARED_IMAGE_HPP
#define OPENCV_IIB_DETAIL_PREPARED_IMAGE_HPP

#include <vector>

#include "opencv2/core.hpp"

namespace cv { namespace iib {

//! @cond IGNORED

//! A prepared image, for several calls of refineMatches and propagateMatches.
struct CV_EXPORTS PreparedImage
{
    PreparedImage() {}
    //! @param image as in refineMatches. @throws cv::Exception (StsBadArg) as refineMatches.
    explicit PreparedImage(InputArray image);

    Mat pixels;  //!< CV_8U, locally normalized, a view of a larger matrix
};

//! refineMatches of images that were prepared.
CV_EXPORTS void refineMatches(const PreparedImage& image1, const std::vector<KeyPoint>& keypoints1,
        const PreparedImage& image2, const std::vector<KeyPoint>& keypoints2,
        const std::vector<DMatch>& matches1to2, OutputArray points1, OutputArray points2,
        OutputArray covariances = noArray(), OutputArray similarities = noArray());

//! propagateMatches of images that were prepared.
CV_EXPORTS void propagateMatches(const PreparedImage& image1, const std::vector<KeyPoint>& keypoints1,
        const PreparedImage& image2, const std::vector<KeyPoint>& keypoints2,
        std::vector<DMatch>& matches1to2, OutputArray points1, OutputArray points2,
        OutputArray covariances = noArray(), OutputArray similarities = noArray());

//! @endcond

}}  // namespace cv::iib

#endif
