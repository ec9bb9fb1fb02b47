// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <mutex>

#include "opencv2/iib.hpp"
#include "opencv2/iib/detail/prepared_image.hpp"

namespace cv::iib {

//! Refined matches of two images, N x 2 each, CV_64F, in working pixels, and what they come from.
struct AlignedPoints
{
    Mat reference, image;
    std::vector<KeyPoint> keypoints[2];  //!< of both, all that were looked for
};

//! Where a transform has a point.
Point2d moved(const Matx33d& by, const Point2d& point);

/** An image at working sizes, reduced by whole factors; what is found in it is kept. Threads may share one. */
class WorkingImage
{
public:
    struct Described
    {
        std::vector<KeyPoint> keypoints;
        Mat codes;
    };

    /** @param mask CV_8UC1 of the image's size, 0 where no points are to be found, or empty.
    @throws cv::Exception (StsBadArg) for another mask */
    WorkingImage(const Mat& image, const Mat& mask);

    Size size() const { return full_.size(); }
    Size size(int factor) const { return {full_.cols / factor, full_.rows / factor}; }
    int factorFor(int workingSize) const;
    int largestFactor() const;  //!< that leaves something to match by

    //! Whether it has a pixel there that its mask allows. @param point in the reduced image.
    bool shows(const Point2d& point, int factor) const;

    Mat pixels(int factor) const;
    const Described& described(int factor) const;
    const PreparedImage& prepared(int factor) const;

private:
    Mat full_, mask_;
    mutable std::mutex mutex_;
    mutable std::map<int, Described> described_;
    mutable std::map<int, PreparedImage> prepared_;
};

/** Two images that are matched at a working size, at which large ones have something to match by, and whose matches are refined at
full size afterwards. Working pixels are those of the reduced images. */
class WorkingPair
{
public:
    /** @param workingSize pixels of the longer side, at most.
    @param sameScale whether both are reduced by one factor, however their sizes differ. */
    WorkingPair(const WorkingImage& reference, const WorkingImage& image, int workingSize, bool sameScale);

    //! @param rotated whether the image may be turned by any angle (matchRotated).
    AlignedPoints match(bool rotated) const;

    bool isReduced() const { return factors_[0] > 1 || factors_[1] > 1; }

    /** Matches again, at full size, those that agree with a transform of working pixels, from where it has them; without those that
    cannot be refined, as where the images are blurred. */
    AlignedPoints refined(
            const AlignedPoints& points, const std::vector<bool>& agree, const Matx33d& transform) const;

    //! Of the reference, 0, or the image, 1, working pixels.
    Size size(int which) const { return images_[which]->size(factors_[which]); }

    //! Whether one of them has a working pixel there that its mask allows.
    bool shows(int which, const Point2d& point) const
    {
        return images_[which]->shows(point, factors_[which]);
    }

    //! A transform between the images' own pixels, and a distance in the reference's.
    Matx33d inPixels(const Matx33d& transform) const;
    double inPixels(double distance) const { return distance * factors_[0]; }

    //! Those that agree, M x 4, CV_32F: x and y in the reference, x and y in the image, their own pixels.
    Mat inPixels(const AlignedPoints& points, const std::vector<bool>& agree) const;

private:
    const WorkingImage* images_[2];
    int factors_[2];
};

}  // namespace cv::iib
