// SPDX-License-Identifier: Apache-2.0

#include "focal_check.hpp"

#include <limits>

#include "pnp.hpp"

namespace iib_localization {
namespace {

constexpr size_t IMAGES = 6;
constexpr size_t MIN_MATCHES = 50;
constexpr size_t MIN_INLIERS = 50;  // of all images
constexpr int ROUNDS = 10;
constexpr double TOLERANCE = 0.02;  // points of a map err together, so that less than this tells nothing
constexpr double DEVIATIONS = 5;

}  // namespace

void FocalCheck::add(const Location& location)
{
    if (images_.size() == IMAGES || location.matched.size() < MIN_MATCHES)
        return;
    images_.push_back({location.matched, location.estimate.pose});
}

size_t FocalCheck::Fit::inliers() const
{
    size_t count = 0;
    for (const View& view : views)
        count += view.inliers.size();
    return count;
}

Pinhole FocalCheck::scaled(double scale) const
{
    return {scale * camera_.fx, scale * camera_.fy, camera_.cx, camera_.cy};
}

/** Poses found with a wrong focal length, even those that too few matches agree on, are near enough to begin with.
Returns the standard deviation of the scale. */
double FocalCheck::refine(Fit& fit) const
{
    double deviation = std::numeric_limits<double>::infinity();
    for (int round = 0; round < ROUNDS && fit.inliers() >= MIN_INLIERS; round++)
    {
        deviation = refineFocal(camera_, fit.views, fit.scale);
        for (size_t i = 0; i < images_.size(); i++)
            fit.views[i].inliers = agreeing(images_[i].matches, scaled(fit.scale), fit.views[i].pose);
    }
    return deviation;
}

double FocalCheck::scale() const
{
    Fit fit{1, {}};
    for (const Image& image : images_)
        fit.views.push_back({image.pose, agreeing(image.matches, camera_, image.pose)});
    const size_t inliers = fit.inliers();
    const double deviation = refine(fit);
    const bool contradicted =
            std::abs(fit.scale - 1) > std::max(TOLERANCE, DEVIATIONS * deviation) && fit.inliers() > inliers;
    return contradicted ? fit.scale : 1;
}

}  // namespace iib_localization
