// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#ifndef OPENCV_IIB_DESCRIPTOR_KERNELS_BOXES_SIMD_HPP
#define OPENCV_IIB_DESCRIPTOR_KERNELS_BOXES_SIMD_HPP

#include "bits_planes.simd.hpp"
#include "boxes.hpp"
#include "channel_rows.simd.hpp"
#include "mappings.hpp"

namespace cv {
namespace iib {

CV_CPU_OPTIMIZATION_NAMESPACE_BEGIN

namespace {

//! Sums that 32 bits do not hold: rare, so written plainly.
template <typename T>
void sumLongCellRow(const T* const rows[BOX_CELL][BOX_PLANES], int cells, const int64* above, int64* out)
{
    int64 sums[BOX_LANES] = {};
    for (int c = 0; c < cells; c++)
    {
        for (int r = 0; r < BOX_CELL; r++)
            for (int x = BOX_CELL * c; x < BOX_CELL * (c + 1); x++)
            {
                const int64 gx = rows[r][0][x], gy = rows[r][1][x];
                sums[LANE_ABSOLUTE_X] += std::abs(gx);
                sums[LANE_ABSOLUTE_Y] += std::abs(gy);
                sums[LANE_GRADIENT_X] += gx;
                sums[LANE_GRADIENT_Y] += gy;
                sums[LANE_INTENSITY] += rows[r][2][x];
                sums[LANE_ABSOLUTE_SUM] += std::abs(gx + gy);
                sums[LANE_ABSOLUTE_DIFFERENCE] += std::abs(gx - gy);
            }
        for (int i = 0; i < BOX_LANES; i++)
            out[BOX_LANES * (c + 1) + i] = above[BOX_LANES * (c + 1) + i] + sums[i];
    }
}

//! Eight vectors' lanes side by side.
inline void storeInterleaved(const v_int16 lanes[BOX_LANES], short* out)
{
    v_int16 a[BOX_LANES], b[BOX_LANES];
    for (int i = 0; i < 4; i++)
        v_zip(lanes[i], lanes[i + 4], a[2 * i], a[2 * i + 1]);  // 0 4, 1 5, 2 6, 3 7
    for (int half = 0; half < 2; half++)
    {
        v_zip(a[half], a[4 + half], b[2 * half], b[2 * half + 1]);          // 0 2 4 6
        v_zip(a[2 + half], a[6 + half], b[4 + 2 * half], b[5 + 2 * half]);  // 1 3 5 7
    }
    for (int quarter = 0; quarter < 4; quarter++)
    {
        v_int16 first, second;
        v_zip(b[quarter], b[4 + quarter], first, second);
        v_store_aligned(out, first);
        v_store_aligned(out + VTraits<v_int16>::max_nlanes, second);
        out += 2 * VTraits<v_int16>::max_nlanes;
    }
}

enum
{
    SAMPLE_LANES = VTraits<v_samples>::max_nlanes,
    LANE_VECTORS = BOX_LANES / SAMPLE_LANES
};

void sumCellRow(
        const short* const rows[BOX_CELL][BOX_PLANES], int cells, const unsigned* above, unsigned* out)
{
    enum
    {
        CELLS = VTraits<v_int16>::max_nlanes
    };
    short CV_DECL_ALIGNED(CACHE_LINE) values[CELLS * BOX_LANES];
    v_samples sums[LANE_VECTORS];
    for (v_samples& sum : sums)
        sum = v_setall_samples(0);
    for (int first = 0; first < cells; first += CELLS)
    {
        v_int16 lanes[BOX_LANES];
        for (v_int16& lane : lanes)
            lane = vx_setzero_s16();
        for (int r = 0; r < BOX_CELL; r++)
        {
            v_int16 gx[BOX_CELL], gy[BOX_CELL], intensity[BOX_CELL];
            v_load_deinterleave(rows[r][0] + BOX_CELL * first, gx[0], gx[1]);
            v_load_deinterleave(rows[r][1] + BOX_CELL * first, gy[0], gy[1]);
            v_load_deinterleave(rows[r][2] + BOX_CELL * first, intensity[0], intensity[1]);
            for (int i = 0; i < BOX_CELL; i++)
            {
                lanes[LANE_ABSOLUTE_X] += absolute(gx[i]);
                lanes[LANE_ABSOLUTE_Y] += absolute(gy[i]);
                lanes[LANE_GRADIENT_X] += gx[i];
                lanes[LANE_GRADIENT_Y] += gy[i];
                lanes[LANE_INTENSITY] += intensity[i];
                lanes[LANE_ABSOLUTE_SUM] += absolute(v_int16(gx[i] + gy[i]));
                lanes[LANE_ABSOLUTE_DIFFERENCE] += absolute(v_int16(gx[i] - gy[i]));
            }
        }
        storeInterleaved(lanes, values);
        const int count = std::min((int)CELLS, cells - first);
        for (int c = 0; c < count; c++)
        {
            const int at = BOX_LANES * (first + c + 1);
            for (int i = 0; i < LANE_VECTORS; i++)
            {
                const int lane = i * SAMPLE_LANES;
                sums[i] += v_load_samples(values + BOX_LANES * c + lane);
                const v_samples up = v_load_samples((const int*)above + at + lane);
                v_store((int*)out + at + lane, sums[i] + up);
            }
        }
    }
}

/** The edge nearest to a position. As edgeAt(), which measures from `first`: here centres are no dyadic fractions, and
 two borders with different bounds must round alike. */
inline int boxEdge(double position, int first, int limit)
{
    const double p = std::min(std::max(position + 0.5, (double)first), (double)limit);
    const int cut = (int)p;
    return cut - (cut > p);
}

//! The compiler makes vectors of the loop, with this file's instruction set.
void boxPlaces(const BoxFrame& f, const double* x, const double* y, int first, int end, BoxPlaces& places)
{
    const double half = f.side / 2;
    const float full = (float)f.side * (float)f.side;
    const int left = f.bounds.x, right = f.bounds.x + f.bounds.width;
    const int top = f.bounds.y, bottom = f.bounds.y + f.bounds.height;
    for (int i = first; i < end; i++)
    {
        const double boxX = f.x + (f.cosine * x[i] - f.sine * y[i]) - half;
        const double boxY = f.y + (f.sine * x[i] + f.cosine * y[i]) - half;
        const int x0 = boxEdge(boxX, left, right), x1 = boxEdge(boxX + f.side, left, right);
        const int y0 = boxEdge(boxY, top, bottom), y1 = boxEdge(boxY + f.side, top, bottom);
        places.corner[i] = (y0 - f.origin.y) * f.step + (x0 - f.origin.x);
        places.right[i] = x1 - x0;
        places.below[i] = (y1 - y0) * f.step;
        places.weight[i] = full / ((float)(x1 - x0) * (float)(y1 - y0));
    }
}

void boxMeans(const unsigned* integral, const BoxPlaces& places, int count, float* means)
{
    for (int i = 0; i < count; i++)
    {
        const int* const a = (const int*)integral + (size_t)places.corner[i] * BOX_LANES;
        const int* const b = a + (size_t)places.right[i] * BOX_LANES;
        const size_t below = (size_t)places.below[i] * BOX_LANES;
        const v_means weight = v_setall_means(places.weight[i]);
        for (int lane = 0; lane < BOX_LANES; lane += SAMPLE_LANES)
        {
            const v_samples sum = (v_load_samples(b + below + lane) - v_load_samples(a + below + lane)) -
                                  (v_load_samples(b + lane) - v_load_samples(a + lane));
            v_store(means + i * BOX_LANES + lane, v_cvt_f32(sum) * weight);
        }
    }
}

void longBoxMeans(const int64* integral, const BoxPlaces& places, int count, float* means)
{
    for (int i = 0; i < count; i++)
    {
        const int64* const a = integral + (size_t)places.corner[i] * BOX_LANES;
        const int64* const b = a + (size_t)places.right[i] * BOX_LANES;
        const size_t below = (size_t)places.below[i] * BOX_LANES;
        for (int lane = 0; lane < BOX_LANES; lane++)
            means[i * BOX_LANES + lane] =
                    (float)((b[below + lane] - a[below + lane]) - (b[lane] - a[lane])) * places.weight[i];
    }
}

void rotateMeans(const float matrix[BOX_LANES][BOX_LANES], int count, float* means)
{
    for (int i = 0; i < count; i++)
    {
        float* const m = means + i * BOX_LANES;
        float rotated[BOX_LANES] = {};
        for (int j = 0; j < BOX_LANES - 1; j++)
            for (int k = 0; k < BOX_LANES; k++)
                rotated[k] += matrix[j][k] * m[j];
        std::copy(rotated, rotated + BOX_LANES, m);
    }
}

//! Bits of a comparison of four or eight lanes, into a byte that was zero.
struct PutLanes
{
    uchar* bytes;
    int lane;

    template <typename V> void operator()(int bit, const V& greater) const
    {
        bytes[bit] |= (uchar)(v_signmask(greater) << lane);
    }
};

inline unsigned boxBits(const v_float32x4& v)
{
    const v_uint64x2 pairs = v_reinterpret_as_u64(v);
    const v_float32x4 swapped = v_reinterpret_as_f32((pairs << 32) | (pairs >> 32));
    const v_float32x4 firstTwo = v_reinterpret_as_f32(v_uint32x4(~0u, ~0u, 0, 0));
    const v_float32x4 lastSign = v_reinterpret_as_f32(v_uint32x4(0, 0, 0, 1u << 31));
    const v_float32x4 partners = swapped & firstTwo, turned = swapped ^ lastSign;
    return (unsigned)v_signmask(v > partners) | (unsigned)v_signmask(v > turned) << 4;
}

void boxLevelBits(const float* means, const BoxComparisons& level, uchar* descriptor)
{
    uchar buffer[MAX_BOXES * 4 + 8];
    uchar* out = buffer;
    for (const BoxComparisons::Quad& quad : level.quads)
    {
        out[0] = out[1] = out[2] = 0;
        for (int lane = 0; lane < BOX_LANES; lane += SAMPLE_LANES)
        {
            const v_means x[4] = {v_load_means(means + quad.boxes[0] * BOX_LANES + lane),
                    v_load_means(means + quad.boxes[1] * BOX_LANES + lane),
                    v_load_means(means + quad.boxes[2] * BOX_LANES + lane),
                    v_load_means(means + quad.boxes[3] * BOX_LANES + lane)};
            const PutLanes put = {out, lane};
            HaarMapping::map(x, put);
        }
        out += HaarMapping::BITS;
    }
    for (ushort box : level.boxes)
        *out++ = (uchar)boxBits(v_load(means + box * BOX_LANES));
    BitWriter writer(descriptor, level.offset);
    appendChosen(level.chosen, buffer, writer);
}

BoxKernels boxKernels()
{
    const BoxKernels k = {sumCellRow, sumLongCellRow<short>, sumLongCellRow<int>, boxMeans, longBoxMeans,
            boxPlaces, rotateMeans, boxLevelBits};
    return k;
}

}  // namespace

CV_CPU_OPTIMIZATION_NAMESPACE_END

}  // namespace iib
}  // namespace cv

#endif
