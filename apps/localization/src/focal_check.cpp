// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#include "focal_check.hpp"

#include "pnp.hpp"

namespace iib_localization {
namespace {

constexpr size_t IMAGES = 6;
constexpr size_t MIN_MATCHES = 50;
constexpr size_t MIN_INLIERS = 15;  // of an image, or it is left out
constexpr int ROUNDS = 10;
constexpr double TOLERANCE = 0.02;  // points of a map err together, so that less than this tells nothing
constexpr double DEVIATIONS = 5;

}  // namespace

void FocalCheck::add(const Location& location)
{
    if (images_.size() == IMAGES || location.matched.size() < MIN_MATCHES)
        return;
    images_.push_back({location.matched, location.estimate.pose});
    found_ += location.found ? 1 : 0;
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

FocalCheck::Fit FocalCheck::givenFit() const
{
    Fit fit{1, {}};
    for (const Image& image : images_)
        fit.views.push_back({image.pose, agreeing(image.matches, camera_, image.pose)});
    return fit;
}

//! The best of a few focal lengths, each with poses of its own.
FocalCheck::Fit FocalCheck::search() const
{
    Fit best{1, {}};
    for (double scale : {0.5, 0.65, 0.8, 1.0, 1.25, 1.55, 1.9})
    {
        Fit fit{scale, {}};
        for (const Image& image : images_)
        {
            View view;
            if (poseByRansac(image.matches, scaled(scale), view.pose))
                view.inliers = agreeing(image.matches, scaled(scale), view.pose);
            if (view.inliers.size() < MIN_INLIERS)
                view.inliers.clear();
            fit.views.push_back(view);
        }
        if (fit.inliers() > best.inliers())
            best = fit;
    }
    return best;
}

//! Returns the standard deviation of the scale.
double FocalCheck::refine(Fit& fit) const
{
    double deviation = std::numeric_limits<double>::infinity();
    for (int round = 0; round < ROUNDS && fit.inliers() >= MIN_INLIERS; round++)
    {
        deviation = refineFocal(camera_, fit.views, fit.scale);
        for (size_t i = 0; i < images_.size(); i++)
            if (!fit.views[i].inliers.empty())
                fit.views[i].inliers = agreeing(images_[i].matches, scaled(fit.scale), fit.views[i].pose);
    }
    return deviation;
}

double FocalCheck::scale() const
{
    const Fit given = givenFit();
    Fit fit = 2 * found_ > images_.size() ? given : search();
    const double deviation = refine(fit);
    const bool contradicted = std::abs(fit.scale - 1) > std::max(TOLERANCE, DEVIATIONS * deviation) &&
                              fit.inliers() > given.inliers();
    return contradicted ? fit.scale : 1;
}

}  // namespace iib_localization
