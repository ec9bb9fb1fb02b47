// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#pragma once

#include "bits.simd.hpp"
#include "boxes.hpp"

namespace cv { namespace iib {
CV_CPU_OPTIMIZATION_NAMESPACE_BEGIN
namespace {

//! For sums that exceed 32 bits: rare, so scalar.
template <bool ROTATED>
void sumSquareRow(const int* const rows[BOX_SQUARE][BOX_PLANES], int squares, const int64* above, int64* out)
{
    int64 sums[BOX_LANES] = {};
    for (int c = 0; c < squares; c++)
    {
        for (int r = 0; r < BOX_SQUARE; r++)
            for (int x = BOX_SQUARE * c; x < BOX_SQUARE * (c + 1); x++)
            {
                const int64 gx = rows[r][0][x], gy = rows[r][1][x];
                sums[LANE_ABSOLUTE_X] += std::abs(gx);
                sums[LANE_ABSOLUTE_Y] += std::abs(gy);
                sums[LANE_GRADIENT_X] += gx;
                sums[LANE_GRADIENT_Y] += gy;
                sums[LANE_INTENSITY] += rows[r][2][x];
                if (ROTATED)
                {
                    sums[LANE_ABSOLUTE_SUM] += std::abs(gx + gy);
                    sums[LANE_ABSOLUTE_DIFFERENCE] += std::abs(gx - gy);
                }
                else
                {
                    sums[LANE_GRADIENT_SUM] += gx + gy;
                    sums[LANE_GRADIENT_X_AGAIN] += gx;
                }
            }
        for (int i = 0; i < BOX_LANES; i++)
            out[BOX_LANES * (c + 1) + i] = above[BOX_LANES * (c + 1) + i] + sums[i];
    }
}

//! Sums of neighbouring pixels of two planes, in the halves of each 32 bits.
inline v_uint32 pairSums(const v_int16& low, const v_int16& high)
{
    const v_int16 ones = vx_setall_s16(1);
    const v_uint32 mask = vx_setall_u32(0xffff);
    return (v_reinterpret_as_u32(v_dotprod(low, ones)) & mask) |
           (v_reinterpret_as_u32(v_dotprod(high, ones)) << 16);
}

constexpr int SAMPLE_LANES = VTraits<v_samples>::max_nlanes, LANE_VECTORS = BOX_LANES / SAMPLE_LANES;

template <bool ROTATED>
void sumSquareRow(
        const short* const rows[BOX_SQUARE][BOX_PLANES], int squares, const unsigned* above, unsigned* out)
{
    constexpr int SQUARES = VTraits<v_int16>::max_nlanes / BOX_SQUARE;
    short CV_DECL_ALIGNED(CACHE_LINE) values[SQUARES * BOX_LANES];  // a square has 128 bits
    unsigned CV_DECL_ALIGNED(CACHE_LINE) interleaved[SQUARES * BOX_LANES / 2];
    v_samples sums[LANE_VECTORS];
    for (v_samples& sum : sums)
        sum = v_setall_samples(0);
    for (int first = 0; first < squares; first += SQUARES)
    {
        v_int16 plane[2][BOX_PLANES];
        for (int r = 0; r < BOX_SQUARE; r++)
            for (int i = 0; i < BOX_PLANES; i++)
                plane[r][i] = vx_load(rows[r][i] + BOX_SQUARE * first);
        const v_int16 gx = plane[0][0] + plane[1][0], gy = plane[0][1] + plane[1][1];
        v_uint32 pairs[BOX_LANES / 2] = {pairSums(absolute(plane[0][0]) + absolute(plane[1][0]),
                                                 absolute(plane[0][1]) + absolute(plane[1][1])),
                pairSums(gx, gy)};
        const v_int16 intensity = plane[0][2] + plane[1][2];
        if (ROTATED)
        {
            v_int16 sum = vx_setzero_s16(), difference = sum;
            for (int r = 0; r < BOX_SQUARE; r++)
            {
                sum += absolute(v_int16(plane[r][0] + plane[r][1]));
                difference += absolute(v_int16(plane[r][0] - plane[r][1]));
            }
            pairs[2] = pairSums(intensity, sum);
            pairs[3] = pairSums(difference, vx_setzero_s16());
        }
        else
        {
            pairs[2] = pairSums(intensity, v_int16(gx + gy));
            pairs[3] = pairSums(gx, vx_setzero_s16());
        }
        v_store_interleave(interleaved, pairs[0], pairs[1], pairs[2], pairs[3]);
        std::memcpy(values, interleaved, sizeof(values));
        const int count = std::min(SQUARES, squares - first);
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

/** The edge nearest to a position. Unlike edgeAt(), it does not depend on the first edge: offsets are no dyadic fractions, and
 must round alike for all bounds. */
inline int boxEdge(double position, double first, double limit)
{
    const int shift = 1 << 30;  // the cast is a floor for positive numbers
    return (int)(std::min(std::max(position + 0.5, first), limit) + shift) - shift;
}

// Compilers vectorize the loops of this function and the next ones.
void edgesAlong(double centre, double side, Range bounds, const double* offsets, int* edges)
{
    const double first = bounds.start, limit = bounds.end;
    for (int i = 0; i < MAX_BOX_PLACES; i++)
        edges[i] = boxEdge(centre + offsets[i] * side, first, limit);
}

void weightsOf(const int* begins, const int* ends, float numerator, float* weights)
{
    for (int i = 0; i < MAX_BOX_PLACES; i++)
        weights[i] = numerator / (float)std::max(ends[i] - begins[i], 1);
}

void boxEdges(const BoxFrame& f, const double (&offsets)[2][MAX_BOX_PLACES], BoxEdges& edges)
{
    const Range columns(f.bounds.x, f.bounds.x + f.bounds.width),
            rows(f.bounds.y, f.bounds.y + f.bounds.height);
    for (int end = 0; end < 2; end++)
    {
        edgesAlong(f.centre.x, f.side, columns, offsets[end], edges.x[end]);
        edgesAlong(f.centre.y, f.side, rows, offsets[end], edges.y[end]);
    }
    weightsOf(edges.x[0], edges.x[1], 1, edges.xWeights);
    weightsOf(edges.y[0], edges.y[1], BOX_MEAN_STEPS, edges.yWeights);
    const int left = f.left, shift = f.shift, count = f.count;
    for (int end = 0; end < 2; end++)
        for (int i = 0; i < MAX_BOX_PLACES; i++)
        {
            edges.x[end][i] = (edges.x[end][i] - left) * BOX_LANES;
            edges.y[end][i] = RingRows<int>::place(edges.y[end][i] + shift, count);
        }
}

void boxPlaces(const BoxFrame& f, const BoxGridShape& grid, const double* centres, Point2d direction,
        double side, int step, BoxPlaces& places)
{
    const double half = side / 2;
    const double cosine = direction.x * f.side, sine = direction.y * f.side;
    const double left = f.bounds.x, right = f.bounds.x + f.bounds.width;
    const double top = f.bounds.y, bottom = f.bounds.y + f.bounds.height;
    double boxX[BoxPlaces::CAPACITY], boxY[BoxPlaces::CAPACITY];
    for (int row = 0; row < grid.n; row++)
        for (int col = 0; col < grid.n; col++)
        {
            const int i = row * grid.n + col;
            boxX[i] = f.centre.x + (cosine * centres[col] - sine * centres[row]) - half;
            boxY[i] = f.centre.y + (sine * centres[col] + cosine * centres[row]) - half;
        }
    for (int i = 0; i < grid.n * grid.n; i++)
    {
        const int x0 = boxEdge(boxX[i], left, right), x1 = boxEdge(boxX[i] + side, left, right);
        const int y0 = boxEdge(boxY[i], top, bottom), y1 = boxEdge(boxY[i] + side, top, bottom);
        places.above[i] = RingRows<int>::place(y0 + f.shift, f.count) * step + (x0 - f.left);
        places.below[i] = RingRows<int>::place(y1 + f.shift, f.count) * step + (x0 - f.left);
        places.right[i] = x1 - x0;
        places.weight[i] =
                (float)BOX_MEAN_STEPS / ((float)std::max(x1 - x0, 1) * (float)std::max(y1 - y0, 1));
    }
}

//! Sums over a box as floats, from rows of corners and the places of the left and right corners.
inline v_means boxSums(const unsigned* above, const unsigned* below, size_t left, size_t right)
{
    const v_samples sum =
            (v_load_samples((const int*)below + right) - v_load_samples((const int*)above + right)) -
            (v_load_samples((const int*)below + left) - v_load_samples((const int*)above + left));
    return v_cvt_f32(sum);
}

inline v_means boxSums(const int64* above, const int64* below, size_t left, size_t right)
{
    float sums[SAMPLE_LANES];
    for (int i = 0; i < SAMPLE_LANES; i++)
        sums[i] = (float)((below[right + i] - above[right + i]) - (below[left + i] - above[left + i]));
    return v_load_means(sums);
}

inline void storeMeans(short* out, const v_means& m) { v_pack_store(out, nearestInt(m)); }
inline void storeMeans(int* out, const v_means& m) { v_store(out, nearestInt(m)); }
// Two vectors at a time take half the packing, and readers get whole vectors from the store buffer.
inline void storeMeans(short* out, const v_means& a, const v_means& b)
{
    v_store(out, v_pack(nearestInt(a), nearestInt(b)));
}
inline void storeMeans(int* out, const v_means& a, const v_means& b)
{
    storeMeans(out, a);
    storeMeans(out + SAMPLE_LANES, b);
}

template <typename Sum, typename Mean>
void boxMeans(const RingRows<Sum>& integral, const BoxGridShape& grid, const BoxEdges& edges, Mean* means)
{
    const int n = grid.n, first = grid.first;
    const int *const left = edges.x[0] + first, *const right = edges.x[1] + first;
    const float* const weights = edges.xWeights + first;
    for (int row = 0; row < n; row++)
    {
        const Sum* const above = integral.data + (size_t)edges.y[0][first + row] * integral.step;
        const Sum* const below = integral.data + (size_t)edges.y[1][first + row] * integral.step;
        const v_means weight = v_setall_means(edges.yWeights[first + row]);
        Mean* out = means + row * grid.stride() * BOX_LANES;
        const auto meansOf = [&](int i, int lane) {
            return boxSums(above + lane, below + lane, left[i], right[i]) * v_setall_means(weights[i]) *
                   weight;
        };
        for (int i = 0; i < n; i += 2 / LANE_VECTORS, out += 2 * SAMPLE_LANES)
            if (LANE_VECTORS == 2)
                storeMeans(out, meansOf(i, 0), meansOf(i, SAMPLE_LANES));
            else if (i + 1 < n)
                storeMeans(out, meansOf(i, 0), meansOf(i + 1, 0));
            else
                storeMeans(out, meansOf(i, 0));
    }
}

template <typename Sum, typename Mean>
void rotatedBoxMeans(const RingRows<Sum>& integral, const BoxGridShape& grid, const BoxPlaces& places,
        const float matrix[BOX_LANES][BOX_LANES], Mean* means)
{
    float sums[BOX_LANES];
    for (int row = 0; row < grid.n; row++)
        for (int col = 0; col < grid.n; col++)
        {
            const int i = row * grid.n + col;
            const Sum* const above = integral.data + (size_t)places.above[i] * BOX_LANES;
            const Sum* const below = integral.data + (size_t)places.below[i] * BOX_LANES;
            const size_t right = (size_t)places.right[i] * BOX_LANES;
            const v_means weight = v_setall_means(places.weight[i]);
            for (int lane = 0; lane < BOX_LANES; lane += SAMPLE_LANES)
                v_store(sums + lane, boxSums(above + lane, below + lane, 0, right) * weight);
            Mean* const out = means + (row * grid.stride() + col) * BOX_LANES;
            for (int lane = 0; lane < BOX_LANES; lane += SAMPLE_LANES)
            {
                v_means rotated = v_setall_means(0);
                for (int j = 0; j < BOX_LANES - 1; j++)
                    rotated += v_load_means(&matrix[j][lane]) * v_setall_means(sums[j]);
                storeMeans(out + lane, rotated);
            }
        }
}

//! Stores a bit for each lane.
inline void storeGreater(const v_int16& a, const v_int16& b, uchar* out)
{
    storeBytes((unsigned)greaterMask(a, b), VTraits<v_int16>::max_nlanes / 8, out);
}

//! The same for two pairs of vectors.
inline void storeGreater(const v_int16& a, const v_int16& b, uchar* out, const v_int16& nextA,
        const v_int16& nextB, uchar* nextOut)
{
#if CV_AVX512_SKX  // comparisons give masks
    storeGreater(a, b, out);
    storeGreater(nextA, nextB, nextOut);
#else
    constexpr int LANES = VTraits<v_int16>::max_nlanes;
    const unsigned both = laneBits(v_pack(v_int16(a > b), v_int16(nextA > nextB)));
    storeBytes(both, LANES / 8, out);
    storeBytes(both >> LANES, LANES / 8, nextOut);
#endif
}

//! Lanes that are compared with the next lane, |gx| > |gy| and gx > gy; the others are compared with 0.
const short NEXT_IS_PARTNER[BOXES_TOGETHER * BOX_LANES] = {-1, 0, -1, 0, 0, 0, 0, 0, -1, 0, -1, 0, 0, 0, 0, 0,
        -1, 0, -1, 0, 0, 0, 0, 0, -1, 0, -1, 0, 0, 0, 0, 0};

void compareBoxes(const short* means, const BoxGridShape& grid, uchar* out)
{
    constexpr int LANES = VTraits<v_int16>::max_nlanes;
    const int bytes = grid.quadBytes(), below = grid.stride() * BOX_LANES;
    for (int row = 0; row + 1 < grid.n; row++, out += 3 * bytes)
    {
        // sums and differences of the upper and the lower boxes of a column
        const short* m = means + row * below;
        v_int16 sum = v_add_wrap(vx_load(m), vx_load(m + below));
        v_int16 difference = v_sub_wrap(vx_load(m), vx_load(m + below));
        for (int col = 0; col < bytes; col += LANES / BOX_LANES)
        {
            m += LANES;
            const v_int16 nextSum = v_add_wrap(vx_load(m), vx_load(m + below));
            const v_int16 nextDifference = v_sub_wrap(vx_load(m), vx_load(m + below));
            const v_int16 right = eightBehind(difference, nextDifference);
            storeGreater(sum, eightBehind(sum, nextSum), out + col, difference,
                    v_sub_wrap(vx_setzero_s16(), right), out + bytes + col);
            storeGreater(difference, right, out + 2 * bytes + col);
            sum = nextSum;
            difference = nextDifference;
        }
    }
    const v_int16 partners = vx_load(NEXT_IS_PARTNER);
    const auto partnersOf = [&](const v_int16& m) {
        return v_reinterpret_as_s16(v_reinterpret_as_u64(m) >> 16) & partners;
    };
    constexpr int BOXES = LANES / BOX_LANES;
    for (int i = 0; i < grid.n * grid.stride(); i += 2 * BOXES)  // up to one vector more
    {
        const v_int16 m = vx_load(means + i * BOX_LANES), next = vx_load(means + (i + BOXES) * BOX_LANES);
        storeGreater(m, partnersOf(m), out + i, next, partnersOf(next), out + i + BOXES);
    }
}

//! For 16-bit images: rare, so scalar.
void compareBoxes(const int* means, const BoxGridShape& grid, uchar* out)
{
    const int bytes = grid.quadBytes(), below = grid.stride() * BOX_LANES;
    for (int row = 0; row + 1 < grid.n; row++, out += 3 * bytes)
        for (int col = 0; col + 1 < grid.n; col++)
        {
            const int* const m = means + (row * grid.stride() + col) * BOX_LANES;
            unsigned bits[3] = {};
            for (int lane = 0; lane < BOX_LANES; lane++)
            {
                const int a = m[lane], b = m[lane + BOX_LANES], c = m[lane + below],
                          d = m[lane + below + BOX_LANES];
                bits[0] |= (unsigned)(a + c > b + d) << lane;
                bits[1] |= (unsigned)(a + b > c + d) << lane;
                bits[2] |= (unsigned)(a + d > b + c) << lane;
            }
            for (int bit = 0; bit < 3; bit++)
                out[bit * bytes + col] = (uchar)bits[bit];
        }
    for (int i = 0; i < grid.n * grid.stride(); i++)
    {
        const int* const m = means + i * BOX_LANES;
        // no condition on the lane: GCC 12 miscompiles it with the address sanitizer
        const int partners[BOX_LANES] = {m[1], 0, m[3], 0, 0, 0, 0, 0};
        unsigned bits = 0;
        for (int lane = 0; lane < BOX_LANES; lane++)
            bits |= (unsigned)(m[lane] > partners[lane]) << lane;
        out[i] = (uchar)bits;
    }
}

template <typename Mean>
void boxBits(
        const Mean* means, const BoxGridShape& grid, const ChosenBits& chosen, int offset, uchar* descriptor)
{
    uchar comparisons[MAX_BOX_COMPARISONS + ChosenBits::Group::SIZE];
    compareBoxes(means, grid, comparisons);
    BitWriter writer(descriptor, offset);
    appendChosen(chosen, comparisons, writer);
}

template <typename T> BoxSumKernels<T> boxSumKernels()
{
    typedef typename BoxSumKernels<T>::Sum Sum;
    return {{sumSquareRow<false>, sumSquareRow<true>}, boxMeans<Sum, T>, rotatedBoxMeans<Sum, T>, boxBits<T>};
}

}  // namespace
CV_CPU_OPTIMIZATION_NAMESPACE_END
}}  // namespace cv::iib
