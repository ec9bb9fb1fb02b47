// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pose_search.hpp"
#include "../views/image_views.hpp"
#include "image_voting.hpp"

namespace cv::iib {

//! Finds images in a map, for Localizer and MapUpdate. Threads may share one object.
class ImageLocator
{
public:
    //! @param points keypoints to detect in an image; 0: as many as in the map's images.
    ImageLocator(const Map& map, int points, bool lines);

    //! The result refers to the upright image.
    LocatedImage find(const Photograph& image, const Camera& camera, const Affine3d* prior = nullptr) const;

private:
    std::vector<size_t> nearestImages(const Affine3d& pose) const;
    std::vector<size_t> similarImages(const Mat& codes) const;
    //! Matches an image's keypoints with points of some of the map's images.
    std::vector<Match> matchesOf(
            const MapImage& features, const std::vector<size_t>& compared, const Affine3d* prior) const;
    void locate(const Affine3d* prior, LocatedImage& found) const;
    //! Whether the mirror image agrees better with the map; symmetric parts of a mirrored image have wrong poses.
    bool isMirrored(const Mat& image, const Mat& mask, const LocatedImage& found) const;
    std::vector<size_t> similarImagesInViews(const ImageViews& image) const;
    //! Matches views of the image with views of the map's most similar images.
    void locateInViews(const Mat& image, const Mat& mask, LocatedImage& found) const;

    const Map& map_;
    const bool lines_;
    std::vector<double> depths_;  //!< median distance of the points of each image; 0 without points
    Ptr<IIB> iib_;
    Ptr<HierarchicalMatcher> matcher_;
    ImageVoting votes_;
    mutable PreparedPictures pictures_;  //!< of the map's images that were compared so far
    Matx66d mapError_;                   //!< added to accepted poses only
};

//! Converts a location of the upright image to the stored image.
Location asStored(Location location, const Photograph& image);

}  // namespace cv::iib
