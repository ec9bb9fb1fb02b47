// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <mutex>

#include "opencv2/iib/detail/prepared_image.hpp"

namespace cv::iib {

//! A grey copy of an image, of at most 1024 pixels a side, in which its keypoints are refined.
struct Picture
{
    Mat pixels;        //!< CV_8U
    double scale = 1;  //!< picture size over image size
};

Picture pictureOf(const Mat& image);

//! A picture prepared for refinement, one byte a pixel.
struct PreparedPicture
{
    PreparedImage image;
    double scale = 1;
};

//! The pictures of a map's images, each prepared on first use. Threads may share one object.
class PreparedPictures
{
public:
    explicit PreparedPictures(size_t count) : prepared_(count) {}
    PreparedPicture of(size_t number, const Picture& picture);
    //! Frees a picture that is no longer needed.
    void release(size_t number);

private:
    std::mutex mutex_;
    std::vector<PreparedPicture> prepared_;
};

//! Matched keypoints of two images, in pixels of the images.
struct KeypointPairs
{
    std::vector<KeyPoint> fixed, moved;
};

/** Refines the second keypoint of each pair (refineMatches).
@return whether it was refined; the others stay. */
std::vector<bool> refine(const PreparedPicture& fixed, const PreparedPicture& moved, KeypointPairs& pairs);

}  // namespace cv::iib
