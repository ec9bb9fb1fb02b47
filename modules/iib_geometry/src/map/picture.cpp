// SPDX-License-Identifier: Apache-2.0

#include "picture.hpp"

#include "opencv2/iib.hpp"
#include "opencv2/imgproc.hpp"

namespace cv::iib {
namespace {

constexpr int LARGEST_SIDE = 1024;

std::vector<KeyPoint> scaled(std::vector<KeyPoint> keypoints, double scale)
{
    for (KeyPoint& k : keypoints)
    {
        k.pt = Point2d((k.pt.x + .5) * scale - .5, (k.pt.y + .5) * scale - .5);
        k.size = float(k.size * scale);
    }
    return keypoints;
}

}  // namespace

Picture pictureOf(const Mat& image)
{
    Picture picture;
    if (image.channels() == 1)
        picture.pixels = image.clone();
    else
        cvtColor(image, picture.pixels, COLOR_BGR2GRAY);
    const int side = std::max(image.cols, image.rows);
    if (side > LARGEST_SIDE)
    {
        picture.scale = double(LARGEST_SIDE) / side;
        resize(picture.pixels.clone(), picture.pixels, Size(), picture.scale, picture.scale, INTER_AREA);
    }
    return picture;
}

PreparedPicture PreparedPictures::of(size_t number, const Picture& picture)
{
    {
        const std::lock_guard<std::mutex> lock(mutex_);
        if (!prepared_[number].image.pixels.empty())
            return prepared_[number];
    }
    const PreparedPicture made = {PreparedImage(picture.pixels),
            picture.scale};  // outside the lock: two threads may prepare the same picture
    const std::lock_guard<std::mutex> lock(mutex_);
    return prepared_[number] = made;
}

void PreparedPictures::release(size_t number)
{
    const std::lock_guard<std::mutex> lock(mutex_);
    prepared_[number] = PreparedPicture();
}

std::vector<bool> refine(const PreparedPicture& fixed, const PreparedPicture& moved, KeypointPairs& pairs)
{
    std::vector<DMatch> matches;
    for (size_t i = 0; i < pairs.fixed.size(); i++)
        matches.emplace_back(int(i), int(i), 0.f);
    Mat first, second, similarities;
    refineMatches(fixed.image, scaled(pairs.fixed, fixed.scale), moved.image,
            scaled(pairs.moved, moved.scale), matches, first, second, noArray(), similarities);
    std::vector<bool> found;
    for (int i = 0; i < int(matches.size()); i++)
    {
        found.push_back(similarities.at<float>(i) > 0);
        const Vec2f at = second.at<Vec2f>(i);
        if (found.back())
            pairs.moved[size_t(i)].pt =
                    Point2d((at[0] + .5) / moved.scale - .5, (at[1] + .5) / moved.scale - .5);
    }
    return found;
}

}  // namespace cv::iib
