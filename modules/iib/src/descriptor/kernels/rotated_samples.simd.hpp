// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#pragma once

#include "rows.simd.hpp"

namespace cv { namespace iib {
CV_CPU_OPTIMIZATION_NAMESPACE_BEGIN
namespace {

//! Products with a sampleFactor(); 16-bit factors, since 32-bit products are slow.
inline v_samples sampleFactor(short factor) { return v_setall_samples((int)(ushort)factor); }
inline v_samples sampleFactor(int factor) { return v_setall_samples(factor); }
inline v_samples multiplySamples(const v_samples& v, const v_samples& factor, short)
{
    return v_dotprod(v_reinterpret_as_s16(v), v_reinterpret_as_s16(factor));
}
inline v_samples multiplySamples(const v_samples& v, const v_samples& factor, int) { return v * factor; }

//! Brings a coordinate into [0, last], by reflection or clamping.
inline v_samples inside(const v_samples& place, const v_samples& last, bool reflect)
{
    const v_samples zero = v_setall_samples(0);
    if (!reflect)
        return v_min(v_max(place, zero), last);
    const v_samples folded = v_reinterpret_as_s32(v_abs(place));
    return v_max(v_min(folded, last + last - folded), zero);
}

template <typename T>
void sampleIndices(const SampleGrid& grid, const RingRows<T>& rows, int oldest, int* index)
{
    const SampleGrid g = grid;  // a copy, since stores to int* may alias `grid`
    const int n = g.n, cells = g.cells(), lanes = VTraits<v_samples>::max_nlanes;
    const v_samples centreX = v_setall_samples(g.x), centreY = v_setall_samples(g.y);
    const v_samples right = v_setall_samples(g.image.width - 1),
                    bottom = v_setall_samples(g.image.height - 1);
    const v_samples left = v_setall_samples(rows.origin.x), shift = v_setall_samples(rows.shift(oldest)),
                    step = v_setall_samples((int)rows.step / GROUP_CHANNELS);
    // min(place, place - count), unsigned: place - count wraps to a large number if place < count
    const auto count = v_reinterpret_as_u32(v_setall_samples(rows.count));
    // in the order of the points: by dx, then by the parity of the cell
    int alongX[MAX_SAMPLES_IN_ROW], alongY[MAX_SAMPLES_IN_ROW];
    for (int dx = 0, i = 0; dx < g.sub; dx++)
        for (int parity = 0; parity < 2; parity++)
            for (int cell = parity; cell < cells; cell += 2, i++)
            {
                const int u = 2 * (cell * g.sub + dx) + 1 - n;
                alongX[i] = g.fracX + u * g.stepX;
                alongY[i] = g.fracY + u * g.stepY;
            }
    for (int dy = 0; dy < g.sub; dy++)
        for (int dx = 0; dx < g.sub; dx++)
            for (int row = 0; row < cells; row++)
            {
                const int v = 2 * (row * g.sub + dy) + 1 - n;
                const v_samples downX = v_setall_samples(-v * g.stepY), downY = v_setall_samples(v * g.stepX);
                for (int i = dx * cells; i < (dx + 1) * cells; i += lanes, index += lanes)
                {
                    const v_samples x =
                            inside(centreX + ((v_load_samples(alongX + i) + downX) >> 17), right, g.reflect);
                    const v_samples y =
                            inside(centreY + ((v_load_samples(alongY + i) + downY) >> 17), bottom, g.reflect);
                    const auto place = v_reinterpret_as_u32(y + shift);
                    const v_samples inRing = v_reinterpret_as_s32(v_min(place, place - count));
                    v_store(index, inRing * step + (x - left));
                }
            }
}

template <typename T>
void imageSums(const T* pixels, const int* index, int cells, int samplesInCell,
        const GradientRotation& rotation, int* const sums[IMAGE_PLANES])
{
    const int count = cells * cells, lanes = VTraits<v_samples>::max_nlanes;
    const v_samples cosine = sampleFactor((T)rotation.cosine), sine = sampleFactor((T)rotation.sine);
    const v_samples half = v_setall_samples(2048);
    const v_samples angle = v_setall_samples(rotation.steps), mask = v_setall_samples(ORIENTATION_STEPS - 1);
    const v_samples zero = v_setall_samples(0);
    for (int cell = 0; cell < count; cell += lanes)
    {
        v_samples absX = zero, absY = zero, steps = zero, intensity = zero, sumX = zero, sumY = zero;
        for (int s = cell; s < count * samplesInCell; s += count)
        {
            v_samples gx, gy, own, grey;
            loadPixels(pixels, index + s, gx, gy, own, grey);
            steps += ((own + angle) & mask) & ~((gx | gy) == zero);
            intensity += grey;
            const v_samples x =
                    (multiplySamples(gx, cosine, T()) + multiplySamples(gy, sine, T()) + half) >> 12;
            const v_samples y =
                    (multiplySamples(gy, cosine, T()) - multiplySamples(gx, sine, T()) + half) >> 12;
            absX += v_reinterpret_as_s32(v_abs(x));
            absY += v_reinterpret_as_s32(v_abs(y));
            sumX += x;
            sumY += y;
        }
        v_store(sums[0] + cell, absX);
        v_store(sums[1] + cell, absY);
        v_store(sums[2] + cell, steps);
        v_store(sums[3] + cell, intensity);
        v_store(sums[4] + cell, sumX);
        v_store(sums[5] + cell, sumY);
    }
}

void gradientVotes(const int* gx, const int* gy, const int* weights, int count, int* votes)
{
    for (int i = 0; i < count; i += VTraits<v_int32>::max_nlanes)
    {
        const v_float32 x = v_cvt_f32(vx_load(gx + i)), y = v_cvt_f32(vx_load(gy + i));
        v_store(votes + i, nearestInt(exactRoot(x * x + y * y) * v_cvt_f32(vx_load(weights + i))));
    }
}

template <typename T>
void mapSums(const T* pixels, const int* index, int cells, int samplesInCell, int* const sums[GROUP_CHANNELS])
{
    const int count = cells * cells, lanes = VTraits<v_samples>::max_nlanes;
    for (int cell = 0; cell < count; cell += lanes)
    {
        v_samples a = v_setall_samples(0), b = a, c = a, d = a;
        for (int s = cell; s < count * samplesInCell; s += count)
        {
            v_samples va, vb, vc, vd;
            loadPixels(pixels, index + s, va, vb, vc, vd);
            a += va;
            b += vb;
            c += vc;
            d += vd;
        }
        v_store(sums[0] + cell, a);
        v_store(sums[1] + cell, b);
        v_store(sums[2] + cell, c);
        v_store(sums[3] + cell, d);
    }
}

void interleaveSums(const int* const sums[GROUP_CHANNELS], const int addends[GROUP_CHANNELS], int cells,
        CellGrid<unsigned>& grid)
{
    const int half = cells / 2, lanes = VTraits<v_int32x4>::max_nlanes;
    grid.create(cells);
    v_int32x4 addend[GROUP_CHANNELS];
    for (int c = 0; c < GROUP_CHANNELS; c++)
        addend[c] = v_setall_s32(addends[c]);
    for (int row = 0, first = 0; row < cells; row++)
        for (int parity = 0; parity < 2; parity++, first += half)
            for (int i = 0; i < half; i += lanes)
            {
                v_uint32x4 v[GROUP_CHANNELS];
                for (int c = 0; c < GROUP_CHANNELS; c++)
                    v[c] = v_reinterpret_as_u32(v_load(sums[c] + first + i) + addend[c]);
                v_store_interleave(grid.row(row, parity) + i * GROUP_CHANNELS, v[0], v[1], v[2], v[3]);
            }
}

template <typename T> void interleaveRow(const T* const planes[GROUP_CHANNELS], T* out, int width)
{
    for (int x = 0; x < width; x += VTraits<decltype(v_load(out))>::max_nlanes)
        v_store_interleave(out + GROUP_CHANNELS * x, v_load(planes[0] + x), v_load(planes[1] + x),
                v_load(planes[2] + x), v_load(planes[3] + x));
}

template <typename T> RotatedSampleKernels<T> rotatedSampleKernels()
{
    return {sampleIndices<T>, imageSums<T>, gradientVotes, mapSums<T>, interleaveSums, interleaveRow<T>};
}

}  // namespace
CV_CPU_OPTIMIZATION_NAMESPACE_END
}}  // namespace cv::iib
