// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#include "patch_aligner.hpp"

namespace cv {
namespace iib {

namespace {

const double SIGMA = 7;            //!< of the weights, in units of the patch
const double UNITS_OF_PLACE = 16;  //!< of PatchWeights::x and y
const int MOST_STEPS = 12;
const double DEFORMATION_MARGIN =
        4;  //!< pixels that a patch may reach farther than where it starts, besides its move
const double LAST_STEP = 1e-3;      //!< in units: no step follows one that is as short
const double LEAST_DEVIATION = .5;  //!< normalized grey levels: without contrast there is nothing to match
const double LEAST_SIMILARITY = .5;
const double DAMPING_OF_PLACE = 1e-5, DAMPING_OF_MAP = 2e-2;
/* Samples that count like one that is independent of all others, from their weights and from the smoothing: what makes
 covariances agree with true errors (test_refinement_accuracy.cpp). */
const double SAMPLES_OF_INDEPENDENT = 5;
const double LARGEST_SUM = 1 << 17;  //!< of the absolute weights of a sum, so that it fits 32 bits

const double SUM_OF_WEIGHTS = 90000, SUM_OF_ROOTS = 1 << 14;

PatchWeights makeWeights()
{
    PatchWeights w;
    double total[2] = {0, 0};
    for (int i = 0; i < PATCH_COLUMNS; i++)
        w.x[i] = (float)((i - (PATCH_COLUMNS - 1) / 2.) / UNITS_OF_PLACE);
    for (int i = 0; i < PATCH_ROWS; i++)
        w.y[i] = (float)((i - (PATCH_ROWS - 1) / 2.) / UNITS_OF_PLACE);
    const auto gaussian = [](float place) {
        return std::exp(-.5 * std::pow(place * UNITS_OF_PLACE / SIGMA, 2));
    };
    for (float x : w.x)
        total[0] += gaussian(x);
    for (float y : w.y)
        total[1] += gaussian(y);
    // the last places of exp differ among machines: cut off
    const auto rounded = [](double value) { return (float)(cvRound(value * (1 << 20)) / double(1 << 20)); };
    for (int i = 0; i < PATCH_COLUMNS; i++)
        w.columns[i] = rounded(gaussian(w.x[i]) / total[0]);
    for (int i = 0; i < PATCH_ROWS; i++)
        w.rows[i] = rounded(gaussian(w.y[i]) / total[1]);
    for (int r = 0; r < PATCH_ROWS; r++)
        for (int c = 0; c < PATCH_COLUMNS; c++)
        {
            const double weight = (double)w.rows[r] * w.columns[c];
            w.samples[r * PATCH_COLUMNS + c] = (short)cvRound(weight * SUM_OF_WEIGHTS);
            w.roots[r * PATCH_COLUMNS + c] =
                    (short)cvRound(std::sqrt(weight * total[0] * total[1]) * SUM_OF_ROOTS);
        }
    return w;
}

const PatchWeights& patchWeights()
{
    static const PatchWeights weights = makeWeights();
    return weights;
}

template <typename T> double sumOf(const T (&values)[PATCH_SAMPLES], double power)
{
    double sum = 0;
    for (T value : values)
        sum += std::pow((double)value, power);
    return sum;
}

//! The inverse of a positive definite matrix, by Cholesky's decomposition; false where it is not.
bool invert(const Matx66d& m, Matx66d& inverse)
{
    Matx66d root;  // lower triangle; m = root * root'
    for (int i = 0; i < 6; i++)
        for (int j = 0; j <= i; j++)
        {
            double rest = m(i, j);
            for (int k = 0; k < j; k++)
                rest -= root(i, k) * root(j, k);
            if (i == j && !(rest > 0))
                return false;
            root(i, j) = i == j ? std::sqrt(rest) : rest / root(j, j);
        }
    for (int column = 0; column < 6; column++)
    {
        double y[6];
        for (int i = 0; i < 6; i++)
        {
            y[i] = i == column;
            for (int k = 0; k < i; k++)
                y[i] -= root(i, k) * y[k];
            y[i] /= root(i, i);
        }
        for (int i = 5; i >= 0; i--)
        {
            for (int k = i + 1; k < 6; k++)
                y[i] -= root(k, i) * inverse(k, column);
            inverse(i, column) = y[i] / root(i, i);
        }
    }
    return true;
}

}  // namespace

Mat smoothedForAlignment(const Mat& normalized)
{
    Mat result(normalized.size(), CV_8U);
    parallel_for_(
            Range(0, result.rows),
            [&](const Range& range) {
                for (int y = range.start; y < range.end; y++)
                {
                    const uchar* const rows[] = {normalized.ptr(std::max(y - 1, 0)), normalized.ptr(y),
                            normalized.ptr(std::min(y + 1, result.rows - 1))};
                    refinementKernels().smooth(rows, result.ptr(y), result.cols);
                }
            },
            result.rows / 64.);
    return result;
}

PatchAligner::PatchAligner()
    : kernels(refinementKernels()), weights(patchWeights()), window(WINDOW * WINDOW + WINDOW_PADDING),
      samples(PATCH_SAMPLES), derivativesX(PATCH_SAMPLES), derivativesY(PATCH_SAMPLES),
      weightsOfSums(PATCH_SAMPLES * (SUMS - SUM_TEMPLATE))
{
    weightsOf[SUM_SAMPLES] = weights.samples;
    totals[SUM_SAMPLES] = sumOf(weights.samples, 1);
    for (int k = 0; k < SUMS - SUM_TEMPLATE; k++)
        weightsOf[SUM_TEMPLATE + k] = templateWeights[k] = weightsOfSums.data() + k * PATCH_SAMPLES;
}

//! How far a patch reaches from its centre, in x and in y.
static Point2d reachOf(const Matx22d& map)
{
    const double halfColumns = (PATCH_COLUMNS - 1) / 2., halfRows = (PATCH_ROWS - 1) / 2.;
    return Point2d(std::abs(map(0, 0)) * halfColumns + std::abs(map(0, 1)) * halfRows,
            std::abs(map(1, 0)) * halfColumns + std::abs(map(1, 1)) * halfRows);
}

//! The surroundings of a place, beyond the image those of its border.
void PatchAligner::readWindow(const Mat& image, const PatchPlace& place, double margin)
{
    const Point2d reach = reachOf(place.map);
    const int halfWidth = cvCeil(std::min(reach.x + margin, WINDOW / 2 - 1.)) + 1;
    const int halfHeight = cvCeil(std::min(reach.y + margin, WINDOW / 2 - 1.)) + 1;
    pixels = Rect(cvFloor(place.x) + 1 - halfWidth, cvFloor(place.y) + 1 - halfHeight, 2 * halfWidth,
            2 * halfHeight);
    const bool inside = pixels.x >= 0 && pixels.x + pixels.width + WINDOW_PADDING <= image.cols;
    uchar border[2][WINDOW + WINDOW_PADDING];
    const uchar* rows[2];
    for (int y = 0; y <= pixels.height; y++)
    {
        const uchar* row = image.ptr(std::min(std::max(pixels.y + y, 0), image.rows - 1));
        rows[y & 1] = row + pixels.x;
        if (!inside)
        {
            for (int x = 0; x <= pixels.width; x++)
                border[y & 1][x] = row[std::min(std::max(pixels.x + x, 0), image.cols - 1)];
            rows[y & 1] = border[y & 1];
        }
        if (y > 0)
            kernels.readWindow(rows[~y & 1], rows[y & 1], window.data() + (y - 1) * WINDOW, pixels.width);
    }
}

//! False if a sample would be outside the window.
bool PatchAligner::sampleAt(const PatchPlace& place)
{
    const double halfColumns = (PATCH_COLUMNS - 1) / 2., halfRows = (PATCH_ROWS - 1) / 2.;
    const Matx22d& m = place.map;
    const double x = place.x - pixels.x, y = place.y - pixels.y;
    const Point2d reach = reachOf(m) + Point2d(.01, .01);  // for roundings of positions
    if (!(x - reach.x >= 0 && x + reach.x < pixels.width && y - reach.y >= 0 && y + reach.y < pixels.height))
        return false;
    const auto fixed = [](double value) { return cvRound(value * (1 << POSITION_BITS)); };
    const PatchGrid grid = {Point(fixed(x - m(0, 0) * halfColumns - m(0, 1) * halfRows),
                                    fixed(y - m(1, 0) * halfColumns - m(1, 1) * halfRows)),
            Point(fixed(m(0, 0)), fixed(m(1, 0))), Point(fixed(m(0, 1)), fixed(m(1, 1)))};
    kernels.sample(window.data(), grid, samples.data());
    return true;
}

PatchAligner::Moments PatchAligner::momentsOf(bool all) const
{
    static const double squaresOfRoots = sumOf(weights.roots, 2) / 65536 / 65536;
    int sums[SUMS];
    const double squares = kernels.sum(samples.data(), weightsOf, all, weights.roots, sums) / squaresOfRoots;
    const double mean = sums[SUM_SAMPLES] / totals[SUM_SAMPLES];
    Moments moments;
    moments.sums[SUM_SAMPLES] = mean;
    for (int k = SUM_TEMPLATE; all && k < SUMS; k++)
        moments.sums[k] = sums[k] - mean * totals[k];
    moments.deviation = std::sqrt(std::max(squares - mean * mean, 0.));
    return moments;
}

//! Of the samples; false where these cannot tell a place.
bool PatchAligner::makeTemplate()
{
    static const std::vector<short> ones(PATCH_SAMPLES, 1);
    ofTemplate = momentsOf(false);
    const double deviation = ofTemplate.deviation;
    if (!(deviation >= LEAST_DEVIATION * (1 << SAMPLE_BITS)))
        return false;
    float columns[COLUMN_SUMS][PATCH_COLUMNS];
    kernels.derive(samples.data(), derivativesX.data(), derivativesY.data());
    kernels.sumColumns(derivativesX.data(), derivativesY.data(), weights, columns);
    // the sum of column sums, times weights and a power of x
    const auto total = [&](int sum, int power) {
        double result = 0;
        for (int c = 0; c < PATCH_COLUMNS; c++)
            result += columns[sum][c] * (double)weights.columns[c] *
                      (power == 0          ? 1.
                              : power == 1 ? weights.x[c]
                                           : weights.x[c] * (double)weights.x[c]);
        return result;
    };
    // parameters: x, y, xx, xy, yx, yy, the second letter the place that a derivative is multiplied by
    static const struct
    {
        int derivative, x, y;
    } parameters[] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 1, 0}, {1, 0, 1}};
    double means[6];
    float scales[SUMS - SUM_TEMPLATE] = {(float)(LARGEST_SUM / deviation)};
    Matx66d normal;
    for (int i = 0; i < 6; i++)
    {
        const auto& a = parameters[i];
        means[i] = total((a.derivative ? COLUMN_Y : COLUMN_X) + a.y, a.x);
        for (int j = 0; j <= i; j++)
        {
            const auto& b = parameters[j];
            const int products = a.derivative + b.derivative == 0   ? COLUMN_XX
                                 : a.derivative + b.derivative == 1 ? COLUMN_XY
                                                                    : COLUMN_YY;
            normal(i, j) = total(products + a.y + b.y, a.x + b.x);
        }
        if (!(normal(i, i) > 0))
            return false;
        scales[1 + i] = (float)(LARGEST_SUM / std::sqrt(normal(i, i)));
    }
    kernels.weigh(samples.data(), derivativesX.data(), derivativesY.data(), weights,
            (float)ofTemplate.sums[SUM_SAMPLES], scales, templateWeights);
    int ofOnes[SUMS];
    kernels.sum(ones.data(), weightsOf, true, weights.roots, ofOnes);
    std::copy(ofOnes + SUM_TEMPLATE, ofOnes + SUMS, totals + SUM_TEMPLATE);
    ofTemplate = momentsOf(true);
    double ofContrast[6];
    for (int i = 0; i < 6; i++)
    {
        factors[i] = scales[1 + i] * 2 * deviation;
        ofContrast[i] = ofTemplate.sums[SUM_DERIVATIVES + i] / (factors[i] * deviation);
        for (int j = 0; j <= i; j++)
        {
            normal(i, j) = (normal(i, j) - means[i] * means[j]) / (4 * deviation * deviation) -
                           ofContrast[i] * ofContrast[j];
            normal(j, i) = normal(i, j);
        }
        normal(i, i) += i < 2 ? DAMPING_OF_PLACE : DAMPING_OF_MAP;
    }
    return invert(normal, inverse);
}

PatchAlignment PatchAligner::align(
        const Mat& image1, const PatchPlace& place1, const Mat& image2, PatchPlace place, double limit)
{
    const PatchPlace start = place;
    PatchAlignment result = {false, start.x, start.y, -1, {1, 0, 1}};
    readWindow(image1, place1, 1);
    if (!sampleAt(place1) || !makeTemplate())
        return result;
    readWindow(image2, place, 2 * limit + DEFORMATION_MARGIN);
    double first = 0, similarity = 0;
    bool last = false;
    for (int step = 0;; step++)
    {
        if (!sampleAt(place))
            return result;
        const Moments moments = momentsOf(true);
        if (!(moments.deviation >= LEAST_DEVIATION * (1 << SAMPLE_BITS)))
            return result;
        const double contrast = moments.deviation / ofTemplate.deviation;
        similarity = moments.sums[SUM_TEMPLATE] / (ofTemplate.sums[SUM_TEMPLATE] * contrast);
        if (step == 0)
            first = similarity;
        if (last || step == MOST_STEPS)
            break;
        Vec6d gradient;
        for (int i = 0; i < 6; i++)
            gradient[i] = (moments.sums[SUM_DERIVATIVES + i] / contrast -
                                  similarity * ofTemplate.sums[SUM_DERIVATIVES + i]) /
                          (factors[i] * ofTemplate.deviation);
        const Vec6d d = inverse * gradient;
        // the map is that of the template's step, inverted, and the one so far
        const Matx22d change(1 + d[2] / UNITS_OF_PLACE, d[3] / UNITS_OF_PLACE, d[4] / UNITS_OF_PLACE,
                1 + d[5] / UNITS_OF_PLACE);
        const double determinant = change(0, 0) * change(1, 1) - change(0, 1) * change(1, 0);
        if (!(std::abs(determinant) > 1e-3))
            return result;
        const Matx22d back(change(1, 1) / determinant, -change(0, 1) / determinant,
                -change(1, 0) / determinant, change(0, 0) / determinant);
        place.map = place.map * back;
        const Vec2d move = place.map * Vec2d(d[0], d[1]);
        place.x -= move[0];
        place.y -= move[1];
        last = d[0] * d[0] + d[1] * d[1] < LAST_STEP * LAST_STEP;
    }
    const double movedX = place.x - start.x, movedY = place.y - start.y;
    if (!(movedX * movedX + movedY * movedY < limit * limit) || !(similarity > first) ||
            !(similarity > LEAST_SIMILARITY))
        return result;
    const double effective = sumOf(weights.samples, 1) * sumOf(weights.samples, 1) /
                             sumOf(weights.samples, 2) / SAMPLES_OF_INDEPENDENT;
    const double variance = std::max(1 / (similarity * similarity) - 1, 0.) / effective;
    const Matx22d ofPlace(inverse(0, 0), inverse(0, 1), inverse(1, 0), inverse(1, 1));
    const Matx22d covariance = place.map * ofPlace * place.map.t() * variance;
    return {true, place.x, place.y, std::min(similarity, 1.),
            {covariance(0, 0), covariance(0, 1), covariance(1, 1)}};
}

}  // namespace iib
}  // namespace cv
