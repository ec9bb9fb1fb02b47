// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#include "patch_aligner.hpp"

namespace cv { namespace iib {

namespace {

const double SIGMA = 8;            //!< of the weights, in units of the patch
const double UNITS_OF_PLACE = 16;  //!< of PatchWeights::x and y
const double REACH = PATCH - 1;    //!< from the centre to the outermost samples
const int MOST_STEPS = 10;
const double LAST_STEP = .02;               //!< steps end when one is shorter than this many units
const double LARGEST_MOVE = 2;              //!< in pixels
const double MARGIN = LARGEST_MOVE + 4;     //!< pixels of the window beyond the start patch
const double LEAST_DEVIATION = .5;          //!< contrast of a patch, in normalized grey levels
const double LEAST_SIMILARITY = .5;         //!< of accepted matches
const double LEAST_COARSE_SIMILARITY = .3;  //!< see roughlyAgree()
const double LEAST_GUIDED_SIMILARITY = .5;  //!< of a guided match after GUIDED_STEPS
const int GUIDED_STEPS = 3;
const double HALVED = 1 << (WEIGHT_BITS + 1);     //!< unit of halved weights, relative to the sum of samples
const double LIGHT = .06, SHARED_BY_NOISE = .28;  //!< of errors by changed illumination, see covariance()
const double NOISE_MARGIN = 1.15;                 //!< noise is counted this much above its mean
const double LEAST_SIGNAL = .1;                   //!< least share of the normal matrix that is not noise
const double DAMPING_OF_PLACE = 1e-5, DAMPING_OF_WARP = 5e-3;

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

//! Inverts a positive definite matrix in place, by Gauss and Jordan's elimination; false where it is not.
bool invert(Matx66d& m)
{
    for (int k = 0; k < 6; k++)
    {
        if (!(m(k, k) > 0))
            return false;
        const double reciprocal = 1 / m(k, k);
        m(k, k) = 1;
        for (int j = 0; j < 6; j++)
            m(k, j) *= reciprocal;
        for (int i = 0; i < 6; i++)
            if (i != k)
            {
                const double factor = m(i, k);
                m(i, k) = 0;
                for (int j = 0; j < 6; j++)
                    m(i, j) -= factor * m(k, j);
            }
    }
    return true;
}

//! Half the width and height of a patch, in pixels.
Vec2d reachOf(const Matx22d& warp)
{
    return Vec2d(std::abs(warp(0, 0)) + std::abs(warp(0, 1)), std::abs(warp(1, 0)) + std::abs(warp(1, 1))) *
           REACH;
}

/* Variance of a sum of residuals times derivatives, relative to that of independent ones. Both correlations are assumed
 to fall by a constant factor from sample to sample along rows and columns (Bartlett 1946). */
double inflation(const Autocorrelation& a, const Autocorrelation& b)
{
    const double squares = (a.squares + 1.) * (b.squares + 1.);
    const double right = a.right * (double)b.right / squares, below = a.below * (double)b.below / squares;
    return (1 + right) / (1 - right) * (1 + below) / (1 - below);
}

//! The pixels from a place on; the place may lie in the border around the image.
const uchar* pixelsFrom(const Mat& image, const Point& place)
{
    return image.data + place.y * (ptrdiff_t)image.step + place.x;
}

//! TEMPLATE x TEMPLATE interpolated grey levels, `unit` pixels apart.
void resample(const Mat& image, const Vec2d& first, double unit, uchar* values)
{
    const Point corner(cvFloor(first[0]), cvFloor(first[1]));
    const auto fixed = [](double value) { return cvRound(value * 256); };
    int columns[TEMPLATE];
    for (int x = 0; x < TEMPLATE; x++)
        columns[x] = fixed(first[0] - corner.x + x * unit);
    for (int y = 0; y < TEMPLATE; y++)
    {
        const int row = fixed(first[1] - corner.y + y * unit), down = row & 255;
        const uchar* const upper = pixelsFrom(image, corner + Point(0, row >> 8));
        const uchar* const lower = upper + image.step;
        for (int x = 0; x < TEMPLATE; x++)
        {
            const int left = columns[x] >> 8, right = columns[x] & 255;
            const int a = upper[left] * (256 - right) + upper[left + 1] * right;
            const int b = lower[left] * (256 - right) + lower[left + 1] * right;
            *values++ = (uchar)((a * (256 - down) + b * down + (1 << 15)) >> 16);
        }
    }
}

}  // namespace

Mat preparedForAlignment(const Mat& normalized)
{
    const Rect inner(Point(IMAGE_BORDER, IMAGE_BORDER), normalized.size());
    Mat result(inner.height + 2 * IMAGE_BORDER, inner.width + IMAGE_BORDER + WINDOW, CV_8U);
    parallel_for_(
            Range(0, result.rows),
            [&](const Range& range) {
                AlignedBuffer<ushort> sums(inner.width + 2);
                for (int y = range.start; y < range.end; y++)
                {
                    const uchar* rows[3];
                    for (int i = 0; i < 3; i++)
                    {
                        const int centre = std::min(std::max(y - inner.y, 0), inner.height - 1);
                        rows[i] = normalized.ptr(std::min(std::max(centre + i - 1, 0), inner.height - 1));
                    }
                    uchar* const out = result.ptr(y);
                    uchar* const end = out + inner.x + inner.width;
                    refinementKernels().smooth(rows, sums.data(), out + inner.x, inner.width);
                    std::fill_n(out, inner.x, out[inner.x]);
                    std::fill_n(end, WINDOW, end[-1]);
                }
            },
            result.rows / 64.);
    return result(inner);
}

bool roughlyAgree(
        const Mat& image1, const Vec2d& point1, const Mat& image2, const Vec2d& point2, const Matx22d& warp)
{
    const int corner = -COARSE_STEP * (COARSE_PIXELS - 1) / 2;
    const Vec2d reach = reachOf(warp);
    if (!(std::max(reach[0], reach[1]) < IMAGE_BORDER - 2))
        return true;  // the patch reaches beyond the borders of images
    const Point centre1(cvRound(point1[0]), cvRound(point1[1]));
    const Vec2d centre2 = point2 + warp * (Vec2d(centre1.x, centre1.y) - point1);
    const auto fixed = [](double value) { return cvRound(value * (1 << POSITION_BITS)); };
    const Point base(cvFloor(centre2[0]), cvFloor(centre2[1])),
            half(1 << (POSITION_BITS - 1), 1 << (POSITION_BITS - 1));
    Point rows[COARSE_PIXELS];
    for (int y = 0; y < COARSE_PIXELS; y++)
    {
        const Vec2d begin = warp * Vec2d(corner, corner + COARSE_STEP * y);
        rows[y] = Point(fixed(centre2[0] - base.x + begin[0]), fixed(centre2[1] - base.y + begin[1])) + half;
    }
    const CoarseSums s = refinementKernels().coarseSums(pixelsFrom(image1, centre1 + Point(corner, corner)),
            image1.step, pixelsFrom(image2, base), image2.step, rows,
            Point(fixed(warp(0, 0) * COARSE_STEP), fixed(warp(1, 0) * COARSE_STEP)));
    const double all = CoarseSums::WEIGHTS;
    const double covariance = s.products * all - s.first * (double)s.second;
    const double variance1 = s.firstSquares * all - s.first * (double)s.first;
    const double variance2 = s.secondSquares * all - s.second * (double)s.second;
    return covariance > 0 && covariance * covariance >= LEAST_COARSE_SIMILARITY * LEAST_COARSE_SIMILARITY *
                                                                variance1 * variance2;
}

PatchAligner::PatchAligner()
    : kernels(refinementKernels()), weights(patchWeights()), window(WINDOW * WINDOW_STEP),
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
    squaredPlace = 0;
    for (int i = 0; i < PATCH_SAMPLES; i++)
        squaredPlace += weights.gaussian[i] / total * weights.x[i] * weights.x[i] / (1 << 30);
}

//! Reads the patch around a point: whole pixels if the unit is one. @return the point's offset from the patch's centre.
Vec2d PatchAligner::readTemplate(const Mat& image, const Vec2d& point)
{
    if (unit == 1)
    {
        const Point nearest(cvRound(point[0]), cvRound(point[1]));
        pixels1 = pixelsFrom(image, nearest - Point(PATCH, PATCH));
        step1 = image.step;
        kernels.makeTemplate(pixels1, step1, weights, patch);
        return point - Vec2d(nearest.x, nearest.y);
    }
    resample(image, point - Vec2d(PATCH, PATCH) * unit, unit, resampled);
    pixels1 = resampled;
    step1 = TEMPLATE;
    kernels.makeTemplate(pixels1, step1, weights, patch);
    return Vec2d(0, 0);
}

void PatchAligner::readWindow(const Mat& image, const PatchPlace& place)
{
    const Vec2d reach = reachOf(place.warp);
    const int halfWidth = cvCeil(std::min(reach[0] + MARGIN, WINDOW / 2 - 1.)) + 1;
    const int halfHeight = cvCeil(std::min(reach[1] + MARGIN, WINDOW / 2 - 1.)) + 1;
    pixels = Rect(cvFloor(place.centre[0]) + 1 - halfWidth, cvFloor(place.centre[1]) + 1 - halfHeight,
            2 * halfWidth, 2 * halfHeight);
    kernels.readWindow(pixelsFrom(image, pixels.tl()), image.step, pixels.size(), window.data());
}

//! False if a sample would be outside the window.
bool PatchAligner::sampleAt(const PatchPlace& place)
{
    const Vec2d centre = place.centre - Vec2d(pixels.x, pixels.y);
    const Vec2d reach = reachOf(place.warp) + Vec2d(.01, .01);  // positions are rounded
    if (!(centre[0] >= reach[0] && centre[0] + reach[0] < pixels.width && centre[1] >= reach[1] &&
                centre[1] + reach[1] < pixels.height))
        return false;
    const auto fixed = [](const Vec2d& v) {
        return Point(cvRound(v[0] * (1 << POSITION_BITS)), cvRound(v[1] * (1 << POSITION_BITS)));
    };
    const int half = 1 << (POSITION_BITS - 9);  // samples use 2^-8 pixels
    const PatchGrid grid = {fixed(centre - place.warp * Vec2d(REACH, REACH)) + Point(half, half),
            fixed(place.warp * Vec2d(2, 0)), fixed(place.warp * Vec2d(0, 2))};
    kernels.sample(window.data(), grid, samples.data());
    return true;
}

PatchAligner::Moments PatchAligner::momentsOf(const short* values) const
{
    int sums[SUMS];
    kernels.sum(values, weights, patch, sums);
    Moments moments;
    const double share = 1 / totals[SUM_SAMPLES];
    const double mean = moments.mean = sums[SUM_SAMPLES] * share;
    const double squares = sums[SUM_SQUARES] * share * HALVED;
    for (int k = SUM_TEMPLATE; k < SUMS; k++)
        moments.sums[k] = (sums[k] - mean * totals[k]) * share;
    moments.deviation = std::sqrt(std::max(squares - mean * mean, 0.));
    return moments;
}

//! Correlation with the template; 0 without contrast.
double PatchAligner::similarityOf(const Moments& moments) const
{
    if (!(moments.deviation >= LEAST_DEVIATION * (1 << SAMPLE_BITS)))
        return 0;
    return moments.sums[SUM_TEMPLATE] * ofTemplate.deviation /
           (ofTemplate.sums[SUM_TEMPLATE] * moments.deviation);
}

//! Also computes the template's sums.
bool PatchAligner::hasContrast()
{
    int sums[SUMS];
    kernels.sum(ones.data(), weights, patch, sums);
    std::copy_n(sums, SUMS, totals);
    ofTemplate = momentsOf(patch.samples);
    return ofTemplate.deviation >= LEAST_DEVIATION * (1 << SAMPLE_BITS) && ofTemplate.sums[SUM_TEMPLATE] > 0;
}

//! Inverts the normal matrix, once; most matches are refused before. @return false for a degenerate template.
bool PatchAligner::solve()
{
    if (solved)
        return usable;
    solved = true;
    int products[PARAMETERS][PARAMETERS];
    kernels.sumProducts(patch, products);
    const double scale = HALVED / totals[SUM_SAMPLES], reciprocal = 1 / ofTemplate.deviation;
    const double variance = reciprocal * reciprocal;
    const double* const contrast = ofTemplate.sums + SUM_DERIVATIVES;
    for (int i = 0; i < PARAMETERS; i++)
        for (int j = 0; j <= i; j++)
        {
            // brightness and contrast are solved for as well: their share is subtracted
            const double square = products[i][j] * (j < 2 ? 1. : 2.) * scale;
            const double mean = totals[SUM_DERIVATIVES + i] * totals[SUM_DERIVATIVES + j] * scale * scale;
            const double explained = contrast[i] * contrast[j] * HALVED * HALVED * variance;
            inverse(i, j) = inverse(j, i) = (square - mean - explained) * variance;
        }
    for (int i = 0; i < PARAMETERS; i++)
        inverse(i, i) += i < 2 ? DAMPING_OF_PLACE : DAMPING_OF_WARP;
    return usable = invert(inverse);
}

//! A Gauss-Newton step: changes of the six parameters.
Vec6d PatchAligner::step(const Moments& moments) const
{
    const double factor = HALVED / (ofTemplate.deviation * moments.deviation);
    const double explained = similarityOf(moments) * moments.deviation / ofTemplate.deviation;
    Vec6d gradient;
    for (int i = 0; i < PARAMETERS; i++)
        gradient[i] = (moments.sums[SUM_DERIVATIVES + i] - explained * ofTemplate.sums[SUM_DERIVATIVES + i]) *
                      factor;
    return inverse * gradient;
}

/* The shift of the patch that bilinear interpolation causes. At a fraction p between two pixels, a wave of frequency w
 is shifted by p (1 - p) (1 - 2p) w^2 / 6. The mean is taken over 4 x 4 samples. */
Vec2d PatchAligner::interpolationError(const PatchPlace& place) const
{
    const int places[] = {-9, -3, 3, 9};
    Vec2d sum(0, 0);
    for (int y : places)
        for (int x : places)
        {
            const Vec2d sample = place.centre + place.warp * Vec2d(x, y);
            for (int axis = 0; axis < 2; axis++)
            {
                const double part = sample[axis] - cvFloor(sample[axis]);
                sum[axis] += part * (1 - part) * (1 - 2 * part) / 16;
            }
        }
    const double pixelsOfUnits = std::abs(determinant(place.warp));  // squared
    const auto squaredFrequency = [&](ptrdiff_t next) {              // weighted by contrast along a direction
        const SquaredDifferences squares = kernels.squareDifferences(pixels1, step1, next);
        return squares.second / (squares.first + 1.);
    };
    return Vec2d(squaredFrequency(1) * sum[0], squaredFrequency((ptrdiff_t)step1) * sum[1]) *
           (1 / (6 * pixelsOfUnits));
}

/* The covariance of a point for residuals of variance 1, corrected for noise in the normal matrix. Noise of the template
 adds to the squares of its derivatives. Along a straight edge, the normal matrix holds nothing but noise.
 @param noise variance of the template's samples.
 @param ofResiduals estimates how noise correlates among neighbours. */
Matx22d PatchAligner::withoutNoise(const Matx22d& ofPoint, const Matx<double, 6, 2>& ofParameters,
        double noise, const Autocorrelation& ofResiduals) const
{
    const double perSquare = noise / (2 * (ofResiduals.squares + 1.));
    const double across = perSquare * (ofResiduals.squares - ofResiduals.right);
    const double down = perSquare * (ofResiduals.squares - ofResiduals.below);
    const double ofWarp[] = {across * squaredPlace, down * squaredPlace};
    const double inDerivatives[] = {across, down, ofWarp[0], ofWarp[0], ofWarp[1], ofWarp[1]};
    Matx22d sum = Matx22d::zeros();
    for (int i = 0; i < PARAMETERS; i++)
        for (int j = 0; j < 2; j++)
            for (int k = 0; k < 2; k++)
                sum(j, k) += ofParameters(i, j) * inDerivatives[i] * ofParameters(i, k);
    // share of noise in the normal matrix; its eigenvalues say how much larger errors are
    const Matx22d share = sum * ofPoint.inv();
    const double mean = trace(share) / 2;
    const double apart = std::sqrt(std::max(mean * mean - determinant(share), 0.));
    const auto larger = [](double s) { return 1 / std::max(1 - s, LEAST_SIGNAL); };
    const double most = larger(mean + apart);
    const double slope = apart > 1e-9 ? (most - larger(mean - apart)) / (2 * apart) : 0;
    const Matx22d factor = (most - slope * (mean + apart)) * Matx22d::eye() + slope * share;
    return factor * ofPoint * factor.t();
}

/* The point's covariance, from the residuals of the last samples. Independent residuals count as noise. Residuals that
 neighbours share come from changed illumination: LIGHT was measured for them, on photographs of still cameras. */
Matx22d PatchAligner::covariance(const Moments& moments) const
{
    const double similarity = std::min(similarityOf(moments), 1.);
    const double gain = similarity * moments.deviation / ofTemplate.deviation;
    const int fixedGain = cvRound(gain * (1 << GAIN_BITS));
    const int fixedOffset = cvRound((moments.mean - gain * ofTemplate.mean) * (1 << GAIN_BITS));
    short residuals[PATCH_SAMPLES];
    kernels.subtract(samples.data(), weights, patch, fixedGain, fixedOffset, residuals);
    const Autocorrelation ofResiduals = kernels.autocorrelate(residuals);
    const double x = pointOffset[0] / UNITS_OF_PLACE, y = pointOffset[1] / UNITS_OF_PLACE;
    const Matx<double, 2, 6> ofPoint(1, 0, x, y, 0, 0, 0, 1, 0, 0, x, y);
    const Matx<double, 6, 2> ofParameters = inverse * ofPoint.t();
    const Matx22d ofUnit = ofPoint * ofParameters;
    const double remaining = 1 / (similarity * similarity) - 1;  // residual variance over explained variance
    const double greyLevel = (1 << SAMPLE_BITS) / moments.deviation;  // both images are rounded to it
    const double noise = std::max(remaining, greyLevel * greyLevel / 6) / independentSamples;
    const auto scaleOf = [&](int derivative) {
        const Autocorrelation a = kernels.autocorrelate(patch.weights[1 + derivative]);
        return std::sqrt(inflation(ofResiduals, a));
    };
    const Matx22d scale(scaleOf(0), 0, 0, scaleOf(1));
    const double shared = (ofResiduals.right + ofResiduals.below) / (2 * (ofResiduals.squares + 1.));
    const double sharedByLight = std::max(shared - SHARED_BY_NOISE, 0.);
    const double light = LIGHT * sharedByLight * std::sqrt(remaining * trace(ofUnit) / 2);
    // both images have noise; residuals that neighbours share are none
    const double ofTemplateAlone = NOISE_MARGIN * (1 - similarity) * std::max(1 - 2 * sharedByLight, 0.);
    const Matx22d ofSignal = withoutNoise(ofUnit, ofParameters, ofTemplateAlone, ofResiduals);
    return scale * ofSignal * scale * noise + ofUnit * light;
}

void PatchAligner::setTemplate(const Mat& image1, const Vec2d& point, double unitOfPatch)
{
    unit = unitOfPatch;
    pointOffset = readTemplate(image1, point);
    usable = hasContrast();
    solved = false;
}

PatchAlignment PatchAligner::align(const Mat& image2, const PatchPlaces& starts, double least)
{
    const Vec2d detected = starts.begin()->centre;
    const PatchAlignment refused = {false, detected, -1, Matx22d::eye(), Matx22d::eye()};
    if (!usable)
        return refused;
    const auto smaller = [](const PatchPlace& a, const PatchPlace& b) {
        return reachOf(a.warp)[0] < reachOf(b.warp)[0];
    };
    readWindow(image2, *std::max_element(starts.begin(), starts.end(), smaller));
    double similarity = least;
    PatchPlace place = *starts.begin();
    Moments moments = Moments();
    for (const PatchPlace& start : starts)
    {
        const PatchPlace tried = {start.centre - start.warp * pointOffset, start.warp};
        if (!sampleAt(tried))
            continue;
        const Moments found = momentsOf(samples.data());
        if (similarityOf(found) > similarity)
        {
            similarity = similarityOf(found);
            place = tried;
            moments = found;
        }
    }
    if (!(similarity > least) || !solve())
        return refused;
    if (starts.end() - starts.begin() > 1)
        sampleAt(place);
    const double first = similarity;
    for (int i = 1;; i++)
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
        place.warp = place.warp * Matx22d(change(1, 1), -change(0, 1), -change(1, 0), change(0, 0)) *
                     (1 / determinant);
        place.centre -= place.warp * Vec2d(d[0], d[1]);
        if (d[0] * d[0] + d[1] * d[1] < LAST_STEP * LAST_STEP || (i == MOST_STEPS && similarity > first))
            break;
        if (i == MOST_STEPS || !sampleAt(place))
            return refused;
        moments = momentsOf(samples.data());
        similarity = similarityOf(moments);
        if (i == GUIDED_STEPS && least > 0 && similarity < LEAST_GUIDED_SIMILARITY)
            return refused;
    }
    if (!(similarity > LEAST_SIMILARITY))
        return refused;
    place.centre -= interpolationError(place);
    const Vec2d found = place.centre + place.warp * pointOffset, moved = found - detected;
    if (!(moved.dot(moved) < LARGEST_MOVE * LARGEST_MOVE))
        return refused;
    return {true, found, std::min(similarity, 1.), place.warp * covariance(moments) * place.warp.t(),
            place.warp * (1 / unit)};
}

}}  // namespace cv::iib
