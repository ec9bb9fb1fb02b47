// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <mutex>

#include "opencv2/iib/detail/prepared_image.hpp"

namespace cv::iib {

//! An image in grey, reduced to 1024 pixels if its longer side has more, in which keypoints of the image are refined.
struct Picture
{
    Mat pixels;        //!< CV_8U
    double scale = 1;  //!< of its pixels by the image's
};

Picture pictureOf(const Mat& image);

//! A picture as refinement looks at it, a byte a pixel.
struct PreparedPicture
{
    PreparedImage image;
    double scale = 1;

    PreparedPicture() = default;
    explicit PreparedPicture(const Picture& picture) : image(picture.pixels), scale(picture.scale) {}
};

//! Pictures of a map's images, each prepared when it is first asked for. Threads may share one.
class PreparedPictures
{
public:
    explicit PreparedPictures(size_t count) : prepared_(count) {}
    PreparedPicture of(size_t number, const Picture& picture);

private:
    std::mutex mutex_;
    std::vector<PreparedPicture> prepared_;
};

//! Keypoints of two images that show the same, one for one, in pixels of the images.
struct KeypointPairs
{
    std::vector<KeyPoint> fixed, moved;
};

/** Moves the second keypoint of each pair to what the first one shows (refineMatches).
@return whether that was found; the others stay. */
std::vector<bool> refine(const PreparedPicture& fixed, const PreparedPicture& moved, KeypointPairs& pairs);

}  // namespace cv::iib
