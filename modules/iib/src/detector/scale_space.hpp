// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#pragma once

#include "../normalization/kernels/kernels.hpp"

#include <array>

namespace cv { namespace iib {

//! The scales of one resolution: the scales with keypoints and their neighbours.
struct Octave
{
    bool halved;  //!< at half the normalized image's resolution
    Size size;    //!< in its pixels, as all that follows
    std::vector<double> sigmas;
    std::vector<int> borders;  //!< pixels on each side without keypoints of a scale
    std::vector<SmoothingStep> steps;
    int first;       //!< the number, among all scales, of the first of these
    int begin, end;  //!< the scales with keypoints, among `sigmas`

    //! @param scales sigmas in the normalized image's pixels. @param begin, end the scales with keypoints.
    Octave(const std::vector<double>& scales, int begin, int end, bool halved, Size imageSize);
};

/** Responses of an octave's scales for a range of rows, from top to bottom. Only the rows that are still needed are
 held: they stay in the processor's cache. */
class ScaleSpace
{
public:
    //! @param first the first row that advance() is called for, 1 or more: a row needs those above and below it.
    ScaleSpace(const Mat& normalized, const Octave& octave, int first);

    //! Makes ready what the other functions give for row y: `first`, then one more with each call.
    void advance(int y);

    //! Rows of responses: y - 1, y and y + 1.
    const float* const* around(size_t scale) const { return nearRows[scale].data(); }
    //! The upper halves of row y's responses, see upperHalf().
    const short* upper(size_t scale, int y) const { return upperHalves[scale].row(y); }
    //! The largest of these in rows y - 1, y and y + 1.
    const short* largest(size_t scale) const { return maxima[scale].row(0); }

private:
    void readRow(int y, short* out);
    void makeRow(size_t image, int y);
    void makeResponses(int y);

    const FilterKernels& kernels;
    const Mat& normalized;
    const Octave& octave;
    const int first;
    int next;   //!< the row that advance() has not made yet
    int reach;  //!< pixels that filters take beyond the ends of rows

    PaddedRows<short> pixels;  //!< four rows of the normalized image
    // Image 0 is the normalized one, or half of it; image i + 1 is what step i makes of image i.
    std::vector<int> ahead;     //!< by how many rows an image is ahead of advance()'s row
    std::vector<int> earliest;  //!< the first row of an image that is needed
    std::vector<PaddedRows<short>> images;
    std::vector<PaddedRows<short>> smoothedDown;  //!< one row, on the way from an image to the next
    std::vector<PaddedRows<float>> responses;
    std::vector<PaddedRows<short>> upperHalves, maxima;
    std::vector<std::array<const float*, 3>> nearRows;
};

}}  // namespace cv::iib
