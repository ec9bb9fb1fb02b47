// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "bundle.hpp"
#include "features.hpp"
#include "line_matching.hpp"
#include "map.hpp"
#include "retrieval.hpp"

namespace iib_localization {

//! Where an image was taken, and how sure that is.
struct Location
{
    bool found = false;
    std::string reason;    //!< why there is no pose
    RefinedPose estimate;  //!< its covariance is scaled to the residuals
    double metres = 0;     //!< three standard deviations in the worst direction
    double degrees = 0;
    std::vector<Observation> matched;  //!< points of the map and where they may be seen; many are wrong
    std::vector<Observation> inliers;
    std::vector<LineObservation> lineInliers;
    //! Milliseconds of each of STAGES.
    std::vector<double> times;

    static const std::vector<std::string>& stages();
};

enum class Lines
{
    OFF,
    ON  //!< if the map has any
};

//! Localizes single images of one camera in a map.
class Localizer
{
public:
    //! @throws cv::Exception if the map's descriptors are not those that this program makes.
    Localizer(const Map& map, const Camera& camera, Lines lines = Lines::ON);

    //! @param prior about where the camera is; null: the keyframes are found by their codes.
    Location locate(const cv::Mat& grey, const Pose* prior = nullptr) const;

    //! Memory of what finds the keyframes; the map's own comes on top.
    size_t retrievalBytes() const;

private:
    std::vector<size_t> candidates(const Features& features, const Pose* prior) const;
    size_t countSureMatches(const Features& features, size_t keyframe) const;
    std::vector<Observation> match(const Features& features, const std::vector<size_t>& keyframes) const;
    bool estimate(Location& location) const;
    void addLines(Location& location, const cv::Mat& grey, const std::vector<size_t>& keyframes) const;
    void judge(Location& location) const;

    const Map& map_;
    const Camera camera_;
    const Pinhole pinhole_;
    const FeatureMethod method_;
    std::vector<Retrieval> retrievals_;      // of each detector
    std::vector<std::vector<int>> linesOf_;  // each keyframe; empty: without lines
};

}  // namespace iib_localization
