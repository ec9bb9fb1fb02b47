// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#pragma once

#include "kernels/kernels.hpp"

namespace cv {
namespace iib {

//! A smoothing of the image before, and the Hessian that is taken there.
struct SmoothingStep
{
    int spacing;  //!< of the filter's five taps
    SmoothingWeights weights;
    int distance;  //!< of the Hessian's differences; 0: only on the way to a scale
    float factor;  //!< of the determinant of these differences, see HessianDetector
};

/** Steps from the normalized image to Gaussians of `sigmas` (in its pixels, increasing). A step at most doubles the
 variance, so that its taps are never farther apart than the image is smooth. */
std::vector<SmoothingStep> smoothingSteps(const std::vector<double>& sigmas);

/** Responses of all scales for a range of rows, from top to bottom. Only the rows that are still needed are held: they
 stay in the processor's cache. */
class ScaleSpace
{
public:
    //! For rows `first` to `last` of a normalized image, neither of them the image's own first or last.
    ScaleSpace(const Mat& normalized, const std::vector<SmoothingStep>& steps, int first, int last);

    //! Makes ready what the other functions give for row y: `first`, then one more with each call.
    void advance(int y);

    //! A row of responses: y - 1, y or y + 1.
    const float* response(size_t scale, int y) const { return responses[scale].row(y); }
    //! The largest of 3 x 3 responses, of row y.
    const float* largest(size_t scale) const { return maxima[scale].row(0); }

private:
    void makeRow(size_t image, int y);
    void makeResponses(int y);

    const DetectorKernels& kernels;
    const Mat& normalized;
    const std::vector<SmoothingStep>& steps;
    const int first, last;
    int next;   //!< the row that advance() has not made yet
    int reach;  //!< pixels that filters take beyond the ends of rows

    // Image 0 is the normalized one, image i + 1 what step i makes of image i.
    std::vector<int> ahead;     //!< by how many rows an image is ahead of advance()'s row
    std::vector<int> earliest;  //!< the first row of an image that is needed
    std::vector<PaddedRows<short>> images;
    std::vector<PaddedRows<short>> smoothedDown;  //!< one row, on the way from an image to the next
    std::vector<PaddedRows<float>> responses, maxima;
};

}  // namespace iib
}  // namespace cv
