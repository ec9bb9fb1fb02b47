// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#include "patch_aligner.hpp"

namespace cv {
namespace iib {

namespace {

const double SIGMA = 8;            //!< of the weights, in units of the patch
const double UNITS_OF_PLACE = 16;  //!< of PatchWeights::x and y
const double REACH = PATCH - 1;    //!< from the centre to the outermost samples
const int MOST_STEPS = 10;
const double LAST_STEP = .02;  //!< in units: the last step is not longer
const double DEFORMATION_MARGIN =
        4;  //!< pixels that a patch may reach farther than where it starts, besides its move
const double LEAST_DEVIATION = .5;  //!< normalized grey levels: without contrast there is nothing to match
const double LEAST_SIMILARITY = .5;
const double DAMPING_OF_PLACE = 1e-5, DAMPING_OF_MAP = 5e-3;
const int GAIN_BITS = 8;            //!< gains are below 256, samples 2^12: products fit 32 bits
const int LARGEST_RESIDUAL = 4095;  //!< so that sums of weighted squares fit 32 bits

PatchWeights makeWeights()
{
    PatchWeights w;
    const auto fixed = [](double value) { return saturate_cast<short>(cvRound(value * (1 << 15))); };
    for (int i = 0; i < PATCH_SAMPLES; i++)
    {
        const double x = 2 * (i % PATCH) - REACH, y = 2 * (i / PATCH) - REACH;
        const double gaussian = std::exp((x * x + y * y) / (-2 * SIGMA * SIGMA));
        w.x[i] = fixed(x / UNITS_OF_PLACE);
        w.y[i] = fixed(y / UNITS_OF_PLACE);
        w.gaussian[i] = fixed(gaussian);
        w.gaussianX[i] = fixed(gaussian * x / UNITS_OF_PLACE);
        w.gaussianY[i] = fixed(gaussian * y / UNITS_OF_PLACE);
    }
    return w;
}

const PatchWeights& patchWeights()
{
    static const PatchWeights weights = makeWeights();
    return weights;
}

//! The inverse of a positive definite matrix, by Cholesky's decomposition; false where it is not.
bool invert(const Matx66d& m, Matx66d& inverse)
{
    Matx66d root;  // lower triangle, m = root * root'; the diagonal holds reciprocals
    for (int i = 0; i < 6; i++)
        for (int j = 0; j <= i; j++)
        {
            double rest = m(i, j);
            for (int k = 0; k < j; k++)
                rest -= root(i, k) * root(j, k);
            if (i == j && !(rest > 0))
                return false;
            root(i, j) = i == j ? 1 / std::sqrt(rest) : rest * root(j, j);
        }
    for (int column = 0; column < 6; column++)
    {
        double y[6];
        for (int i = 0; i < 6; i++)
        {
            y[i] = i == column;
            for (int k = column; k < i; k++)
                y[i] -= root(i, k) * y[k];
            y[i] *= root(i, i);
        }
        for (int i = 5; i >= column; i--)
        {
            for (int k = i + 1; k < 6; k++)
                y[i] -= root(k, i) * inverse(k, column);
            inverse(i, column) = inverse(column, i) = y[i] * root(i, i);
        }
    }
    return true;
}

//! How far a patch reaches from its centre, in x and in y.
Vec2d reachOf(const Matx22d& map)
{
    return Vec2d(std::abs(map(0, 0)) + std::abs(map(0, 1)), std::abs(map(1, 0)) + std::abs(map(1, 1))) *
           REACH;
}

/* The correlation of values with those `distance` farther; the few that are at both ends of two rows count little, as the
 values have the patch's weights. */
double autocorrelation(const short* values, int distance)
{
    int products = 0, squares = 1;
    for (int i = 0; i < PATCH_SAMPLES - distance; i++)
    {
        products += values[i] * values[i + distance];
        squares += values[i] * values[i];
    }
    return (double)products / squares;
}

/* How much larger the variance of a sum of residuals times derivatives is than if they were independent, if the
 correlations of both fall by the same factor from sample to sample along rows and columns (Bartlett 1946). */
double inflation(const short* residuals, const short* derivatives)
{
    double product = 1;
    for (int distance : {1, PATCH})
    {
        const double r = autocorrelation(residuals, distance) * autocorrelation(derivatives, distance);
        product *= (1 + r) / (1 - r);
    }
    return product;
}

//! Grey level between pixels of an image whose border is repeated.
uchar pixelAt(const Mat& image, const Vec2d& place)
{
    const double x = std::min(std::max(place[0], 0.), image.cols - 1.);
    const double y = std::min(std::max(place[1], 0.), image.rows - 1.);
    const int left = (int)x, above = (int)y;
    const uchar* const upper = image.ptr(above);
    const uchar* const lower = image.ptr(std::min(above + 1, image.rows - 1));
    const int right = std::min(left + 1, image.cols - 1);
    const double a = upper[left] + (upper[right] - upper[left]) * (x - left);
    const double b = lower[left] + (lower[right] - lower[left]) * (x - left);
    return (uchar)cvRound(a + (b - a) * (y - above));
}

}  // namespace

Mat smoothedForAlignment(const Mat& normalized)
{
    Mat result(normalized.size(), CV_8U);
    parallel_for_(
            Range(0, result.rows),
            [&](const Range& range) {
                AlignedBuffer<ushort> sums(result.cols + 2);
                for (int y = range.start; y < range.end; y++)
                {
                    const uchar* const rows[] = {normalized.ptr(std::max(y - 1, 0)), normalized.ptr(y),
                            normalized.ptr(std::min(y + 1, result.rows - 1))};
                    refinementKernels().smooth(rows, sums.data(), result.ptr(y), result.cols);
                }
            },
            result.rows / 64.);
    return result;
}

PatchAligner::PatchAligner()
    : kernels(refinementKernels()), weights(patchWeights()), window(WINDOW * WINDOW + WINDOW_PADDING),
      samples(PATCH_SAMPLES), ones(PATCH_SAMPLES)
{
    std::fill_n(ones.data(), PATCH_SAMPLES, (short)1);
    double total = 0, squares = 0;
    for (double weight : weights.gaussian)
    {
        total += weight;
        squares += weight * weight;
    }
    independentSamples = total * total / squares;
}

/* Reads the patch around a point. Pixels that need no interpolation are taken if that is a unit's size: returned is how far
 the point is from the patch's centre then. */
Vec2d PatchAligner::readTemplate(const Mat& image, const Vec2d& point, double unit)
{
    uchar values[TEMPLATE * TEMPLATE];
    const Point nearest(cvRound(point[0]), cvRound(point[1])), corner = nearest - Point(PATCH, PATCH);
    const bool whole =
            unit == 1 && (Rect(corner, Size(TEMPLATE, TEMPLATE)) & Rect(Point(), image.size())).area() ==
                                 TEMPLATE * TEMPLATE;
    const Vec2d centre = unit == 1 ? Vec2d(nearest.x, nearest.y) : point;
    for (int y = 0; y < TEMPLATE; y++)
        if (whole)
            std::copy_n(image.ptr(corner.y + y) + corner.x, TEMPLATE, values + y * TEMPLATE);
        else
            for (int x = 0; x < TEMPLATE; x++)
                values[y * TEMPLATE + x] = pixelAt(image, centre + Vec2d(x - PATCH, y - PATCH) * unit);
    kernels.makeTemplate(values, weights, patch);
    return point - centre;
}

//! The surroundings of a place, beyond the image those of its border.
void PatchAligner::readWindow(const Mat& image, const PatchPlace& place, double margin)
{
    const Vec2d reach = reachOf(place.map);
    const int halfWidth = cvCeil(std::min(reach[0] + margin, WINDOW / 2 - 1.)) + 1;
    const int halfHeight = cvCeil(std::min(reach[1] + margin, WINDOW / 2 - 1.)) + 1;
    pixels = Rect(cvFloor(place.centre[0]) + 1 - halfWidth, cvFloor(place.centre[1]) + 1 - halfHeight,
            2 * halfWidth, 2 * halfHeight);
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
    const Vec2d centre = place.centre - Vec2d(pixels.x, pixels.y);
    const Vec2d reach = reachOf(place.map) + Vec2d(.01, .01);  // for roundings of positions
    if (!(centre[0] >= reach[0] && centre[0] + reach[0] < pixels.width && centre[1] >= reach[1] &&
                centre[1] + reach[1] < pixels.height))
        return false;
    const auto fixed = [](const Vec2d& v) {
        return Point(cvRound(v[0] * (1 << POSITION_BITS)), cvRound(v[1] * (1 << POSITION_BITS)));
    };
    const PatchGrid grid = {fixed(centre - place.map * Vec2d(REACH, REACH)), fixed(place.map * Vec2d(2, 0)),
            fixed(place.map * Vec2d(0, 2))};
    kernels.sample(window.data(), grid, samples.data());
    return true;
}

PatchAligner::Moments PatchAligner::momentsOf(const short* values) const
{
    int sums[SUMS];
    kernels.sum(values, weights, patch, sums);
    Moments moments;
    const double mean = moments.mean = sums[SUM_SAMPLES] / totals[SUM_SAMPLES];
    const double squares = sums[SUM_SQUARES] / (totals[SUM_SAMPLES] / (1 << (WEIGHT_BITS + 1)));
    for (int k = SUM_TEMPLATE; k < SUMS; k++)
        moments.sums[k] = (sums[k] - mean * totals[k]) / totals[SUM_SAMPLES];
    moments.deviation = std::sqrt(std::max(squares - mean * mean, 0.));
    return moments;
}

//! The correlation with the template; 0 without contrast.
double PatchAligner::similarityOf(const Moments& moments) const
{
    if (!(moments.deviation >= LEAST_DEVIATION * (1 << SAMPLE_BITS)))
        return 0;
    return moments.sums[SUM_TEMPLATE] * ofTemplate.deviation /
           (ofTemplate.sums[SUM_TEMPLATE] * moments.deviation);
}

//! False where the template cannot tell a place.
bool PatchAligner::solveTemplate()
{
    int sums[SUMS];
    kernels.sum(ones.data(), weights, patch, sums);
    std::copy_n(sums, SUMS, totals);
    ofTemplate = momentsOf(patch.samples);
    const double variance = ofTemplate.deviation * ofTemplate.deviation;
    if (!(ofTemplate.deviation >= LEAST_DEVIATION * (1 << SAMPLE_BITS)) ||
            !(ofTemplate.sums[SUM_TEMPLATE] > 0))
        return false;
    int products[PARAMETERS][PARAMETERS];
    kernels.sumProducts(patch, products);
    const double total = totals[SUM_SAMPLES], scale = 1 << (WEIGHT_BITS + 1);
    const double *means = totals + SUM_DERIVATIVES, *contrast = ofTemplate.sums + SUM_DERIVATIVES;
    Matx66d normal;
    for (int i = 0; i < PARAMETERS; i++)
        for (int j = 0; j <= i; j++)
        {
            // less what changes of brightness and of contrast explain, which are solved for as well
            const double square = products[i][j] * (j < 2 ? 1. : 2.) * scale / total;
            const double mean = means[i] * means[j] * scale * scale / total / total;
            normal(i, j) = (square - mean - contrast[i] * contrast[j] * scale * scale / variance) / variance;
            normal(j, i) = normal(i, j);
            if (i == j)
                normal(i, i) += i < 2 ? DAMPING_OF_PLACE : DAMPING_OF_MAP;
        }
    return invert(normal, inverse);
}

//! A step of Gauss and Newton: changes of the six parameters of the patch.
Vec6d PatchAligner::step(const Moments& moments) const
{
    const double similarity = similarityOf(moments), scale = 1 << (WEIGHT_BITS + 1);
    Vec6d gradient;
    for (int i = 0; i < PARAMETERS; i++)
        gradient[i] = (moments.sums[SUM_DERIVATIVES + i] / moments.deviation -
                              similarity * ofTemplate.sums[SUM_DERIVATIVES + i] / ofTemplate.deviation) *
                      scale / ofTemplate.deviation;
    return inverse * gradient;
}

//! Of the point that is `beside` the patch's centre, in its units, from what remains of the samples that were taken last.
Matx22d PatchAligner::covariance(const Moments& moments, const Vec2d& beside) const
{
    const double similarity = similarityOf(moments);
    const double gain = similarity * moments.deviation / ofTemplate.deviation;
    const int fixedGain = cvRound(gain * (1 << GAIN_BITS));
    const int fixedMean = cvRound((moments.mean - gain * ofTemplate.mean) * (1 << GAIN_BITS));
    const short* const values = samples.data();
    short residuals[PATCH_SAMPLES];
    for (int i = 0; i < PATCH_SAMPLES; i++)
    {
        const int residual = values[i] - ((fixedGain * patch.samples[i] + fixedMean) >> GAIN_BITS);
        const int limited = std::min(std::max(residual, -LARGEST_RESIDUAL), LARGEST_RESIDUAL);
        residuals[i] = (short)(limited * weights.gaussian[i] >> 16);
    }
    const double x = beside[0] / UNITS_OF_PLACE, y = beside[1] / UNITS_OF_PLACE;
    const Matx<double, 2, 6> ofPoint(1, 0, x, y, 0, 0, 0, 1, 0, 0, x, y);
    const double greyLevel = (1 << SAMPLE_BITS) / moments.deviation;  // both images are rounded to whole ones
    const double variance =
            std::max(1 / (similarity * similarity) - 1, greyLevel * greyLevel / 6) / independentSamples;
    const Matx22d scale(std::sqrt(inflation(residuals, patch.weights[1])), 0, 0,
            std::sqrt(inflation(residuals, patch.weights[2])));
    return scale * (ofPoint * inverse * ofPoint.t() * variance) * scale;
}

PatchAlignment PatchAligner::align(const Mat& image1, const Vec2d& point, double unit, const Mat& image2,
        const std::vector<PatchPlace>& starts, double limit)
{
    const Vec2d detected = starts[0].centre;
    const PatchAlignment refused = {false, detected, -1, Matx22d::eye()};
    const Vec2d beside = readTemplate(image1, point, unit);
    if (!solveTemplate())
        return refused;
    const auto smaller = [](const PatchPlace& a, const PatchPlace& b) {
        return reachOf(a.map)[0] < reachOf(b.map)[0];
    };
    readWindow(image2, *std::max_element(starts.begin(), starts.end(), smaller), limit + DEFORMATION_MARGIN);
    double first = -2;
    PatchPlace place = starts[0];
    Moments moments = Moments();
    for (const PatchPlace& start : starts)
    {
        const PatchPlace tried = {start.centre - start.map * beside, start.map};
        if (!sampleAt(tried))
            continue;
        const Moments found = momentsOf(samples.data());
        if (similarityOf(found) > first)
        {
            first = similarityOf(found);
            place = tried;
            moments = found;
        }
    }
    double similarity = first;
    for (int i = 0; i < MOST_STEPS; i++)
    {
        if (!(similarity > 0))
            return refused;
        // @cite BakerMatthews2004 Eq. (35)
        const Vec6d d = step(moments);
        const Matx22d change(1 + d[2] / UNITS_OF_PLACE, d[3] / UNITS_OF_PLACE, d[4] / UNITS_OF_PLACE,
                1 + d[5] / UNITS_OF_PLACE);
        const double determinant = change(0, 0) * change(1, 1) - change(0, 1) * change(1, 0);
        if (!(std::abs(determinant) > 1e-3))
            return refused;
        place.map = place.map * Matx22d(change(1, 1), -change(0, 1), -change(1, 0), change(0, 0)) *
                    (1 / determinant);
        place.centre -= place.map * Vec2d(d[0], d[1]);
        if (d[0] * d[0] + d[1] * d[1] < LAST_STEP * LAST_STEP)
            break;
        if (!sampleAt(place))
            return refused;
        moments = momentsOf(samples.data());
        similarity = similarityOf(moments);
    }
    const Vec2d found = place.centre + place.map * beside, moved = found - detected;
    if (!(moved.dot(moved) < limit * limit) || !(similarity > first) || !(similarity > LEAST_SIMILARITY))
        return refused;
    return {true, found, std::min(similarity, 1.), place.map * covariance(moments, beside) * place.map.t()};
}

}  // namespace iib
}  // namespace cv
