// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pose_search.hpp"
#include "../views/image_views.hpp"
#include "image_voting.hpp"

namespace cv::iib {

//! Finds images in a map; what Localizer and MapUpdate share. Threads may share one.
class ImageLocator
{
public:
    //! @param points keypoints that are looked for in an image; 0: as many as in the map's images.
    ImageLocator(const Map& map, int points, bool lines);

    //! Of the image that is turned upright.
    LocatedImage find(const Photograph& image, const Camera& camera, const Affine3d* prior = nullptr) const;

private:
    std::vector<size_t> near(const Affine3d& pose) const;
    std::vector<size_t> similar(const Mat& codes) const;
    //! Of an image's keypoints with points that images of the map see.
    std::vector<Match> matchesOf(
            const Features& features, const std::vector<size_t>& compared, const Affine3d* prior) const;
    void locate(const Camera& camera, const Affine3d* prior, LocatedImage& found) const;
    //! Whether the mirror image agrees better with the map: else symmetric parts of a mirrored image have a pose that is wrong.
    bool isMirrored(const Camera& camera, const Mat& image, const Mat& mask, const LocatedImage& found) const;
    std::vector<size_t> similarInViews(const ImageViews& image) const;
    //! By views of the image and of the map's images that it was compared with.
    void locateInViews(const Camera& camera, const Mat& image, const Mat& mask, LocatedImage& found) const;

    const Map& map_;
    const bool lines_;
    std::vector<double> depths_;  //!< how far lies what each image of the map sees; 0 if it sees nothing
    Ptr<IIB> iib_;
    Ptr<HierarchicalMatcher> matcher_;
    ImageVoting votes_;
    mutable PreparedPictures pictures_;  //!< of the map's images that were compared so far
    Matx66d mapError_;                   //!< which is no reason to doubt that an image was found
};

//! A location of the image that is turned upright, for that of the file.
Location inFile(Location location, const Photograph& image);

}  // namespace cv::iib
