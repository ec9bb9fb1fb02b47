// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "robust_fit.hpp"

namespace cv::iib {

/** A Problem of robust_fit.hpp: a transform of the plane between two images, 3 x 3, last entry 1, without mirroring. The error of
a match is the distance in the first image, pixels. */
class PlanarProblem
{
public:
    typedef Matx33d Model;
    typedef Vec<double, 8> Step;

    //! Points in pixels; kind of AlignmentModel.
    PlanarProblem(const Points& reference, const Points& image, int kind);

    int size() const { return (int)image_.size(); }
    int sampleSize() const { return parameters() / 2; }
    int parameters() const { return entries_.back().step + 1; }

    void propose(const std::vector<int>& sample, std::vector<Matx33d>& transforms) const;
    double loss(const Matx33d& transform, const Loss& by, double limit) const;
    //! Assumes a transform that does not mirror; infinite beyond the horizon.
    double squaredError(const Matx33d& transform, int reference, int image) const;
    void squaredErrors(const Matx33d& transform, std::vector<double>& errors) const;
    void linearize(const Matx33d& transform, double limit, std::vector<Row<Step>>& rows) const;
    Matx33d moved(const Matx33d& transform, const Step& step) const;

    //! None: derivatives hardly depend on the points' noise.
    std::vector<Square<Step>> noiseInDerivatives(const Matx33d&, const std::vector<Row<Step>>&, double) const
    {
        return {};
    }

    //! Converts a Model, which transforms normalized coordinates, to pixels.
    Matx33d inPixels(const Matx33d& transform) const;
    Matx33d fromPixels(const Matx33d& transform) const;

    //! Standard deviation, in pixels of the reference, of a transformed pixel of the image.
    double deviation(const Matx33d& transform, const Square<Step>& covariance, const Point2d& pixel) const;

private:
    struct Place
    {
        Vec2d at;
        Matx<double, 2, 8> byStep;
    };
    struct Entry  // the step adds its parameter, times the value, to an entry of the matrix
    {
        int step, row, column;
        double value;
    };
    Place placeOf(const Matx33d& transform, const Vec3d& point) const;

    std::vector<Entry> entries_;            // in the order of the parameters
    std::vector<Vec3d> reference_, image_;  // normalized: centred, of the order of one, third coordinate 1
    Matx33d fromReference_, fromImage_;     // pixels to normalized coordinates
    double unit_;                           // pixels per normalized unit
};

}  // namespace cv::iib
