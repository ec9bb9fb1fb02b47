// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#include "patch_aligner.hpp"

namespace cv {
namespace iib {

namespace {

const double SIGMA = 8;            //!< of the weights, in units of the patch
const double UNITS_OF_PLACE = 16;  //!< of PatchWeights::x and y
const int COARSE_ROW_STEP = 2;
const int COARSE_STEPS = 6, MOST_STEPS = 12;  //!< all, and those that may look at some rows alone
const double DEFORMATION_MARGIN =
        4;  //!< pixels that a patch may reach farther than where it starts, besides its move
const double LAST_COARSE_STEP = .2,
             LAST_STEP = .02;       //!< in units: no step of the same kind follows one that is shorter
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

//! The sum of a power of the values in each rowStep-th row.
double sumOfPowers(const short* values, int power, int rowStep)
{
    double sum = 0;
    for (int i = 0; i < PATCH_SAMPLES; i++)
        if (i / PATCH_COLUMNS % rowStep == 0)
            sum += power == 1 ? values[i] : values[i] * values[i];
    return sum;
}

//! The sum of all samples' products from those of columns, times a power of x.
double total(const float* columns, const PatchWeights& weights, int power)
{
    double sums[4] = {};
    for (int c = 0; c < PATCH_COLUMNS; c++)
    {
        const double x = weights.x[c];
        sums[c % 4] += (double)columns[c] * weights.columns[c] * (power == 0 ? 1 : power == 1 ? x : x * x);
    }
    return (sums[0] + sums[1]) + (sums[2] + sums[3]);
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
    std::fill_n(weightsOfSums.data(), PATCH_SAMPLES * (SUMS - SUM_TEMPLATE), (short)0);
    weightsOf[SUM_SAMPLES] = weights.samples;
    for (int k = 0; k < SUMS - SUM_TEMPLATE; k++)
        weightsOf[SUM_TEMPLATE + k] = templateWeights[k] = weightsOfSums.data() + k * PATCH_SAMPLES;
    for (Level* level : {&coarse, &fine})
    {
        level->rowStep = level == &coarse ? COARSE_ROW_STEP : 1;
        level->totals[SUM_SAMPLES] = sumOfPowers(weights.samples, 1, level->rowStep);
        level->squaresOfRoots = sumOfPowers(weights.roots, 2, level->rowStep) / 65536 / 65536;
    }
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
bool PatchAligner::sampleAt(const PatchPlace& place, const Level& level)
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
    kernels.sample(window.data(), grid, level.rowStep, samples.data());
    return true;
}

PatchAligner::Moments PatchAligner::momentsOf(const short* values, const Level& level) const
{
    int sums[SUMS];
    const double squares =
            kernels.sum(values, weightsOf, weights.roots, level.rowStep, sums) / level.squaresOfRoots;
    const double mean = sums[SUM_SAMPLES] / level.totals[SUM_SAMPLES];
    Moments moments;
    moments.sums[SUM_SAMPLES] = mean;
    for (int k = SUM_TEMPLATE; k < SUMS; k++)
        moments.sums[k] = sums[k] - mean * level.totals[k];
    moments.deviation = std::sqrt(std::max(squares - mean * mean, 0.));
    return moments;
}

//! The correlation with the template; 0 without contrast.
double PatchAligner::similarityOf(const Moments& moments, const Level& level) const
{
    if (!(moments.deviation >= LEAST_DEVIATION * (1 << SAMPLE_BITS)))
        return 0;
    return moments.sums[SUM_TEMPLATE] * level.ofTemplate.deviation /
           (level.ofTemplate.sums[SUM_TEMPLATE] * moments.deviation);
}

//! Of the samples; false where these cannot tell a place.
bool PatchAligner::makeTemplate()
{
    const Moments moments = momentsOf(samples.data(), fine);
    const double deviation = moments.deviation;
    if (!(deviation >= LEAST_DEVIATION * (1 << SAMPLE_BITS)))
        return false;
    float columns[COLUMN_SUMS][PATCH_COLUMNS];
    kernels.derive(samples.data(), derivativesX.data(), derivativesY.data());
    kernels.sumColumns(derivativesX.data(), derivativesY.data(), weights, columns);
    // the derivative of each parameter, and what that is multiplied by: x and y of the place, and the linear map's four
    static const struct
    {
        int derivative, x, y;
    } parameters[] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 1, 0}, {1, 0, 1}};
    static const int products[] = {COLUMN_XX, COLUMN_XY, COLUMN_YY};
    double means[6];
    float scales[SUMS - SUM_TEMPLATE] = {(float)(LARGEST_SUM / deviation)};
    Matx66d normal;
    for (int i = 0; i < 6; i++)
    {
        const auto& a = parameters[i];
        means[i] = total(columns[(a.derivative ? COLUMN_Y : COLUMN_X) + a.y], weights, a.x);
        for (int j = 0; j <= i; j++)
        {
            const auto& b = parameters[j];
            normal(i, j) =
                    total(columns[products[a.derivative + b.derivative] + a.y + b.y], weights, a.x + b.x);
        }
        if (!(normal(i, i) > 0))
            return false;
        scales[1 + i] = (float)(LARGEST_SUM / std::sqrt(normal(i, i)));
        factors[i] = scales[1 + i] * 2 * deviation;
    }
    kernels.weigh(samples.data(), derivativesX.data(), derivativesY.data(), weights,
            (float)moments.sums[SUM_SAMPLES], scales, templateWeights);
    for (Level* level : {&coarse, &fine})
    {
        // up to roundings, which count only as far as the patches' means differ, and these are small
        level->totals[SUM_TEMPLATE] = 0;
        for (int i = 0; i < 6; i++)
            level->totals[SUM_DERIVATIVES + i] = means[i] * scales[1 + i] / level->rowStep;
        level->ofTemplate = momentsOf(samples.data(), *level);
    }
    for (int i = 0; i < 6; i++)
    {
        // what a change of contrast explains, which is solved for as well
        const double* contrast = fine.ofTemplate.sums + SUM_DERIVATIVES;
        for (int j = 0; j <= i; j++)
        {
            normal(i, j) = (normal(i, j) - means[i] * means[j]) / (4 * deviation * deviation) -
                           contrast[i] * contrast[j] / (factors[i] * factors[j] * deviation * deviation);
            normal(j, i) = normal(i, j);
        }
        normal(i, i) += i < 2 ? DAMPING_OF_PLACE : DAMPING_OF_MAP;
    }
    return invert(normal, inverse);
}

//! A step of Gauss and Newton, @cite BakerMatthews2004 Eq. (35); false where the map degenerates.
bool PatchAligner::move(PatchPlace& place, const Moments& moments, const Level& level, double& distance) const
{
    const double contrast = moments.deviation / level.ofTemplate.deviation;
    const double similarity = similarityOf(moments, level);
    const double scale = level.totals[SUM_SAMPLES] / fine.totals[SUM_SAMPLES] * level.ofTemplate.deviation;
    Vec6d gradient;
    for (int i = 0; i < 6; i++)
        gradient[i] = (moments.sums[SUM_DERIVATIVES + i] / contrast -
                              similarity * level.ofTemplate.sums[SUM_DERIVATIVES + i]) /
                      (factors[i] * scale);
    const Vec6d d = inverse * gradient;
    const Matx22d change(1 + d[2] / UNITS_OF_PLACE, d[3] / UNITS_OF_PLACE, d[4] / UNITS_OF_PLACE,
            1 + d[5] / UNITS_OF_PLACE);
    const double determinant = change(0, 0) * change(1, 1) - change(0, 1) * change(1, 0);
    if (!(std::abs(determinant) > 1e-3))
        return false;
    const Matx22d back(change(1, 1) / determinant, -change(0, 1) / determinant, -change(1, 0) / determinant,
            change(0, 0) / determinant);
    place.map = place.map * back;
    const Vec2d step = place.map * Vec2d(d[0], d[1]);
    place.x -= step[0];
    place.y -= step[1];
    distance = std::sqrt(d[0] * d[0] + d[1] * d[1]);
    return true;
}

PatchAlignment PatchAligner::align(const Mat& image1, const PatchPlace& place1, const Mat& image2,
        const std::vector<PatchPlace>& starts, double limit)
{
    PatchPlace place = starts[0];
    const Point2d detected(place.x, place.y);
    const PatchAlignment refused = {false, place.x, place.y, -1, {1, 0, 1}};
    readWindow(image1, place1, 1);
    if (!sampleAt(place1, fine) || !makeTemplate())
        return refused;
    const auto smaller = [](const PatchPlace& a, const PatchPlace& b) {
        return reachOf(a.map).x < reachOf(b.map).x;
    };
    readWindow(image2, *std::max_element(starts.begin(), starts.end(), smaller), limit + DEFORMATION_MARGIN);
    double first = -2;
    for (const PatchPlace& start : starts)
    {
        if (!sampleAt(start, coarse))
            continue;
        const double similarity = similarityOf(momentsOf(samples.data(), coarse), coarse);
        if (similarity > first)
        {
            first = similarity;
            place = start;
        }
    }
    double similarity = 0;
    for (int step = 0; step < MOST_STEPS; step++)
    {
        Level& level = step < COARSE_STEPS ? coarse : fine;
        if (!sampleAt(place, level))
            return refused;
        const Moments moments = momentsOf(samples.data(), level);
        similarity = similarityOf(moments, level);
        double distance;
        if (!(similarity > 0) || !move(place, moments, level, distance))
            return refused;
        if (distance < (step < COARSE_STEPS ? LAST_COARSE_STEP : LAST_STEP))
        {
            if (step >= COARSE_STEPS)
                break;
            step = COARSE_STEPS - 1;
        }
    }
    const Point2d moved = Point2d(place.x, place.y) - detected;
    if (!(moved.dot(moved) < limit * limit) || !(similarity > first) || !(similarity > LEAST_SIMILARITY))
        return refused;
    static const double independent = std::pow(fine.totals[SUM_SAMPLES], 2) /
                                      sumOfPowers(weights.samples, 2, 1) / SAMPLES_OF_INDEPENDENT;
    const double variance = std::max(1 / (similarity * similarity) - 1, 0.) / independent;
    const Matx22d ofPlace(inverse(0, 0), inverse(0, 1), inverse(1, 0), inverse(1, 1));
    const Matx22d covariance = place.map * ofPlace * place.map.t() * variance;
    return {true, place.x, place.y, std::min(similarity, 1.),
            {covariance(0, 0), covariance(0, 1), covariance(1, 1)}};
}

}  // namespace iib
}  // namespace cv
