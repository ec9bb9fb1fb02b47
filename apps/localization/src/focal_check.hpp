// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "localizer.hpp"

namespace iib_localization {

/** Notices a camera whose focal length is not what cameras.txt says: poses are then biased, or not found at all. Looks at
the first six images with enough matches. */
class FocalCheck
{
public:
    explicit FocalCheck(const Pinhole& camera) : camera_(camera) {}

    void add(const Location& location);

    //! How many times the given focal length the images tell; 1 if they do not contradict it.
    double scale() const;

private:
    struct Image
    {
        std::vector<Observation> matches;
        Pose pose;
    };
    struct Fit
    {
        double scale;
        std::vector<View> views;

        size_t inliers() const;
    };

    Pinhole scaled(double scale) const;
    double refine(Fit& fit) const;

    const Pinhole camera_;
    std::vector<Image> images_;
};

}  // namespace iib_localization
