// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#include "scale_space.hpp"

namespace cv { namespace iib {

namespace {

/** Steps from an image of Gaussian smoothness `variance` to increasing `sigmas`. A step at most doubles the variance, so that
 its taps are close enough together. */
std::vector<SmoothingStep> smoothingSteps(const std::vector<double>& sigmas, double variance)
{
    const double unit = 40 << CONTRAST_BITS;  // a local standard deviation
    std::vector<SmoothingStep> steps;
    for (double sigma : sigmas)
    {
        const double wanted = sigma * sigma;
        while (wanted - variance > 1e-9)
        {
            const double added = std::min(wanted - variance, std::max(variance, 4. / 3));
            // Five taps: twice (w, 1 - 2 w, w), each of which adds 2 w spacing^2. w <= 1/3 gives a single peak.
            const int spacing = cvCeil(std::sqrt(.75 * added));
            const double w = added / (4 * spacing * spacing);
            steps.push_back({spacing, (short)cvRound(2 * w * (1 - 2 * w) * 65536),
                    (short)cvRound(w * w * 65536), 0, 0});
            variance += added;
        }
        const int distance = std::max(cvRound(.75 * sigma), 1);
        steps.back().distance = distance;
        steps.back().factor = (float)(wanted * wanted / (std::pow(distance, 4.) * unit * unit));
    }
    return steps;
}

}  // namespace

Octave::Octave(const std::vector<double>& scales, int begin_, int end_, bool halved_, Size imageSize)
    : halved(halved_), size(halved ? Size(imageSize.width / 2, imageSize.height / 2) : imageSize),
      first(std::max(begin_ - 1, 0)), begin(begin_ - first), end(end_ - first)
{
    for (int i = first; i < std::min(end_ + 1, (int)scales.size()); i++)
    {
        sigmas.push_back(scales[i] / (halved ? 2 : 1));
        borders.push_back((int)(2 * sigmas.back()) + 2);
    }
    steps = smoothingSteps(sigmas, halved ? 3. / 16 : 0.);  // the variance of the weights 1, 3, 3, 1
}

ScaleSpace::ScaleSpace(const Mat& normalized_, const Octave& octave_, int first_)
    : kernels(filterKernels()), normalized(normalized_), octave(octave_), first(first_), next(first_ - 2),
      reach(0), pixels(Size(normalized_.cols, octave_.halved ? 4 : 0), 2, true),
      ahead(octave_.steps.size() + 1, 0), earliest(octave_.steps.size() + 1, first_ - 1)
{
    const std::vector<SmoothingStep>& steps = octave.steps;
    const int width = octave.size.width;
    // From the last image back: which rows the images made of it need, relative to advance()'s row.
    std::vector<int> oldest(ahead.size(), 0);
    for (size_t i = steps.size(); i-- > 0;)
    {
        const SmoothingStep& s = steps[i];
        if (s.distance)
        {
            ahead[i + 1] = std::max(ahead[i + 1], 1 + s.distance);
            oldest[i + 1] = std::min(oldest[i + 1], 1 - s.distance);
            earliest[i + 1] = std::min(earliest[i + 1], first - 1 - s.distance);
        }
        ahead[i] = ahead[i + 1] + 2 * s.spacing;
        oldest[i] = ahead[i + 1] - 2 * s.spacing;
        earliest[i] = earliest[i + 1] - 2 * s.spacing;
        reach = std::max(reach, std::max(2 * s.spacing, s.distance));
    }
    for (size_t i = 0; i < ahead.size(); i++)
    {
        earliest[i] = std::max(earliest[i], 0);
        next = std::min(next, earliest[i] - ahead[i]);
        images.push_back(PaddedRows<short>(Size(width, ahead[i] - oldest[i] + 1), reach, true));
    }
    smoothedDown.push_back(PaddedRows<short>(Size(width, 1), reach, true));
    for (const SmoothingStep& s : steps)
        if (s.distance)
        {
            responses.push_back(PaddedRows<float>(Size(width, 3), 1, true));
            upperHalves.push_back(PaddedRows<short>(Size(width, 3), 1, true));
            maxima.push_back(PaddedRows<short>(Size(width, 1), 1, true));
        }
    nearRows.resize(responses.size());
}

void ScaleSpace::advance(int y)
{
    for (; next <= y; next++)
    {
        for (size_t i = 0; i < images.size(); i++)
            if (next + ahead[i] >= earliest[i] && next + ahead[i] < octave.size.height)
                makeRow(i, next + ahead[i]);
        if (next + 1 >= first - 1)
            makeResponses(next + 1);
    }
    for (size_t i = 0; i < nearRows.size(); i++)
        for (int dy = 0; dy < 3; dy++)
            nearRows[i][dy] = responses[i].row(y - 1 + dy);
}

//! Row y of image 0.
void ScaleSpace::readRow(int y, short* out)
{
    if (!octave.halved)
        return kernels.centre(normalized.ptr(y), out, normalized.cols);
    const short* rows[4];
    for (int i = 0; i < 4; i++)
    {
        short* const row = pixels.row(i);
        kernels.centre(normalized.ptr(std::min(std::max(2 * y + i - 1, 0), normalized.rows - 1)), row,
                normalized.cols);
        pixels.repeatEnds(i, normalized.cols, 2);
        rows[i] = row;
    }
    kernels.halveShorts(rows, out, octave.size.width);
}

void ScaleSpace::makeRow(size_t image, int y)
{
    short* const out = images[image].row(y);
    const int width = octave.size.width;
    if (image == 0)
        readRow(y, out);
    else
    {
        const SmoothingStep& s = octave.steps[image - 1];
        const short* rows[5];
        for (int i = 0; i < 5; i++)
            rows[i] = images[image - 1].row(
                    std::min(std::max(y + (i - 2) * s.spacing, 0), octave.size.height - 1));
        kernels.smooth(rows, s, smoothedDown[0].row(0), out, width);
    }
}

void ScaleSpace::makeResponses(int y)
{
    size_t scale = 0;
    for (size_t i = 0; i < octave.steps.size(); i++)
        if (const int d = octave.steps[i].distance)
        {
            const short* const rows[] = {images[i + 1].row(std::max(y - d, 0)), images[i + 1].row(y),
                    images[i + 1].row(std::min(y + d, octave.size.height - 1))};
            PaddedRows<short>& upper = upperHalves[scale];
            kernels.response(rows, d, octave.steps[i].factor,
                    {responses[scale].row(y), upper.row(y), upper.row(y - 1), upper.row(y - 2),
                            maxima[scale].row(0)},
                    octave.size.width);
            scale++;
        }
}

}}  // namespace cv::iib
