// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#pragma once

#include "patch_aligner.hpp"

#include "opencv2/iib/detail/prepared_image.hpp"

namespace cv { namespace iib {

//! A match to refine, and its result.
struct Refinement
{
    DMatch match;
    bool guided;   //!< whether the search begins with `warp`, not with the keypoints' angles and sizes
    Matx22d warp;  //!< from the first image's surroundings of the keypoint to the second's
    PatchAlignment found;

    explicit Refinement(const DMatch& match_) : match(match_), guided(false), found() {}
    Refinement(const DMatch& match_, const Matx22d& warp_) : match(match_), guided(true), warp(warp_), found()
    {
    }
};

//! Refines matches of two images' keypoints by least-squares matching.
class MatchRefiner
{
public:
    //! @throws cv::Exception for keypoints that are not finite and for matches of others.
    MatchRefiner(const PreparedImage& image1, const PreparedImage& image2,
            const std::vector<KeyPoint>& keypoints1, const std::vector<KeyPoint>& keypoints2,
            const std::vector<DMatch>& matches);

    void refine(std::vector<Refinement>& matches) const;

    //! Whether a coarse comparison allows a match. @param warp as in Refinement.
    bool mayMatch(int query, int train, const Matx22d& warp) const;

    Size firstSize() const { return images[0].pixels.size(); }
    Size secondSize() const { return images[1].pixels.size(); }
    //! Whether an image contains its keypoint.
    bool containsFirst(size_t index) const { return isInside(first[index], images[0].pixels); }
    bool containsSecond(size_t index) const { return isInside(second[index], images[1].pixels); }

private:
    struct Start;

    int rotationOf(const std::vector<DMatch>& matches) const;
    Start begin(const Refinement& refinement) const;
    static bool isInside(const KeyPoint& keypoint, const Mat& image);

    const std::vector<KeyPoint>&first, &second;
    const PreparedImage images[2];
    int rotation;  //!< estimated from the given matches of keypoints without angles; degrees, 0 to 360
};

//! Adds the matches of further keypoints that the refined matches predict.
void propagate(const MatchRefiner& refiner, const std::vector<KeyPoint>& keypoints1,
        const std::vector<KeyPoint>& keypoints2, std::vector<Refinement>& matches);

}}  // namespace cv::iib
