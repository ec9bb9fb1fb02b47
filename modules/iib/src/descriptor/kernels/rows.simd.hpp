// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#pragma once

#include "kernels.hpp"
#include "vectors.simd.hpp"

namespace cv { namespace iib {
CV_CPU_OPTIMIZATION_NAMESPACE_BEGIN
namespace {

inline v_int16 addModulo(const v_int16& a, const v_int16& b) { return v_add_wrap(a, b); }
inline v_int32 addModulo(const v_int32& a, const v_int32& b) { return a + b; }

inline v_int16 setAll(short v) { return vx_setall_s16(v); }
inline v_int32 setAll(int v) { return vx_setall_s32(v); }

/* The orientation within an octant, atan(lo / hi), in steps. The division is in the constructor, so that other work may overlap
 it. */
class OctantSteps32
{
public:
    //! 0 <= lo <= hi, hi > 0.
    OctantSteps32(const v_int32& lo, const v_int32& hi) : t(exactQuotient(v_cvt_f32(lo), v_cvt_f32(hi))) {}

    v_int32 operator()() const
    {
        const v_float32 t2 = t * t;
        return nearestInt(((c() * t2 + b()) * t2 + a()) * t);
    }

    //! The same for lo, hi < 2^11, with fused operations: for such values they do not change the result.
    v_int32 ofShortSides() const
    {
        const v_float32 t2 = t * t;
        return nearestInt(v_muladd(v_muladd(c(), t2, b()), t2, a()) * t);
    }

private:
    static v_float32 a() { return vx_setall_f32(ATAN_A); }
    static v_float32 b() { return vx_setall_f32(ATAN_B); }
    static v_float32 c() { return vx_setall_f32(ATAN_C); }

    const v_float32 t;
};

//! Computes even and odd lanes separately, without shuffles.
class OctantSteps16
{
public:
    OctantSteps16(const v_int16& lo, const v_int16& hi)
        : even(v_reinterpret_as_s32(lo) & low(), v_reinterpret_as_s32(hi) & low()),
          odd(v_reinterpret_as_s32(lo) >> 16, v_reinterpret_as_s32(hi) >> 16)
    {
    }

    v_int16 operator()() const
    {
        return v_reinterpret_as_s16(even.ofShortSides() | (odd.ofShortSides() << 16));
    }

private:
    static v_int32 low() { return vx_setall_s32(0xffff); }

    const OctantSteps32 even, odd;
};

inline OctantSteps16 octantSteps(const v_int16& lo, const v_int16& hi) { return OctantSteps16(lo, hi); }
inline OctantSteps32 octantSteps(const v_int32& lo, const v_int32& hi) { return OctantSteps32(lo, hi); }

//! A gradient, its absolute values and its orientation.
template <typename T, typename V> struct Gradient
{
    V x, y, absoluteX, absoluteY;

    Gradient(const V& gx, const V& gy) : x(gx), y(gy), absoluteX(absolute(gx)), absoluteY(absolute(gy)) {}

    //! Sobel 3x3. The rows begin one pixel to the left.
    static Gradient sobel(const T* above, const T* middle, const T* below)
    {
        const V a0 = vx_load(above), a1 = vx_load(above + 1), a2 = vx_load(above + 2);
        const V m0 = vx_load(middle), m2 = vx_load(middle + 2);
        const V b0 = vx_load(below), b1 = vx_load(below + 1), b2 = vx_load(below + 2);
        const V dm = m2 - m0, d0 = b0 - a0, d1 = b1 - a1, d2 = b2 - a2;
        return Gradient(((a2 - a0) + (b2 - b0)) + (dm + dm), (d0 + d2) + (d1 + d1));
    }

    auto octant() const -> decltype(octantSteps(absoluteX, absoluteY))
    {
        return octantSteps(v_min(absoluteX, absoluteY), v_max(v_max(absoluteX, absoluteY), setAll((T)1)));
    }

    //! atan2(-gy, gx), modulo ORIENTATION_STEPS. @param s steps within its octant.
    V orientation(V s) const
    {
        const V zero = setAll((T)0);
        s = subtractWhereLess(absoluteX, absoluteY, setAll((T)(ORIENTATION_STEPS / 4)), s);
        s = subtractWhereLess(x, zero, setAll((T)(ORIENTATION_STEPS / 2)), s);
        s = subtractWhereLess(zero, y, setAll((T)ORIENTATION_STEPS), s);
        return s & setAll((T)(ORIENTATION_STEPS - 1));
    }
};

//! Processes two vectors at a time, so that their divisions overlap.
template <typename T>
void imageChannelRows(
        const ImageRows<T>& in, T signedOffset, const ImageChannelRows<T>& out, ptrdiff_t above, int width)
{
    typedef decltype(setAll(T())) V;
    constexpr int N = VTraits<V>::max_nlanes;
    const ImageRows<T> rows = in;  // copies, since stores may alias the arguments
    T *const absoluteX = out.of[0], *const absoluteY = out.of[1], *const steps = out.of[2],
             *const pixels = out.of[3], *const signedX = out.of[4], *const signedY = out.of[5];
    const V offset = setAll(signedOffset);
    for (int x = 0; x < width; x += 2 * N)
    {
        const T *const top = rows.above + x, *const middle = rows.middle + x, *const below = rows.below + x;
        const auto g = Gradient<T, V>::sobel(top, middle, below);
        const auto h = Gradient<T, V>::sobel(top + N, middle + N, below + N);
        const auto put = [above](T* row, const V& values) {
            v_store(row, above ? addModulo(values, vx_load(row + above)) : values);
        };
        const auto putBoth = [&](T* row, const V& first, const V& second) {
            put(row + x, first);
            put(row + x + N, second);
        };
        if (pixels)
            putBoth(pixels, vx_load(middle + 1), vx_load(middle + N + 1));
        if (signedX)
            putBoth(signedX, g.x + offset, h.x + offset);
        if (signedY)
            putBoth(signedY, g.y + offset, h.y + offset);
        if (absoluteX)
            putBoth(absoluteX, g.absoluteX, h.absoluteX);
        if (absoluteY)
            putBoth(absoluteY, g.absoluteY, h.absoluteY);
        if (steps)
        {
            const auto first = g.octant(), second = h.octant();
            putBoth(steps, g.orientation(first()), h.orientation(second()));
        }
    }
}

template <typename Pixel, typename T> void widenRow(const Pixel* in, T* out, int width)
{
    for (int x = 0; x < width; x++)
        out[x] = (T)in[x];
}

//! Prefix sums within each four pixels of a plane, from pixel x on; modulo 2^16.
inline v_uint16 loadSums(const short* plane, int x)
{
    const v_uint16 v = v_reinterpret_as_u16(vx_load(plane + x));
    // 16-bit additions: for valgrind, a 64-bit sum is undefined if any of its pixels is
    const v_uint16 two = v_add_wrap(v, v_reinterpret_as_u16(v_reinterpret_as_u64(v) << 16));
    return v_add_wrap(two, v_reinterpret_as_u16(v_reinterpret_as_u64(two) << 32));
}

//! The same for four planes, interleaved.
inline void interleave(const short* const planes[GROUP_CHANNELS], int x, v_uint16 pixels[4])
{
    const v_uint16 sums[GROUP_CHANNELS] = {
            loadSums(planes[0], x), loadSums(planes[1], x), loadSums(planes[2], x), loadSums(planes[3], x)};
    interleaveFour(sums, pixels);
}

void sumRow16(const short* const planes[GROUP_CHANNELS], int width, const ushort* above, ushort* out)
{
    const int step = VTraits<v_uint16>::max_nlanes, pixelsInVector = step / GROUP_CHANNELS;
    v_uint16 carry = vx_setzero_u16();
    for (int x = 0; x < width; x += step)
    {
        v_uint16 pixels[4];
        interleave(planes, x, pixels);
        for (int i = 0; i < 4; i++)
        {
            const int at = (x + i * pixelsInVector + 1) * GROUP_CHANNELS;
            const v_uint16 sums = v_add_wrap(addFourthToUpper(pixels[i]), carry);
            v_store(out + at, v_add_wrap(sums, vx_load(above + at)));
            if ((i + 1) * pixelsInVector % 4 == 0)
                carry = repeatLastFour(sums);
        }
    }
}

void sumRow32(const short* const planes[GROUP_CHANNELS], int width, const unsigned* above, unsigned* out)
{
    const int step = VTraits<v_uint16>::max_nlanes, pixelsInVector = step / GROUP_CHANNELS / 2;
    v_uint32 carry = vx_setzero_u32();
    for (int x = 0; x < width; x += step)
    {
        v_uint16 pixels[4];
        interleave(planes, x, pixels);
        for (int i = 0; i < 8; i += 2)
        {
            v_uint32 sums[2];
            v_expand(pixels[i / 2], sums[0], sums[1]);
            for (int j = 0; j < 2; j++)
            {
                const int at = (x + (i + j) * pixelsInVector + 1) * GROUP_CHANNELS;
                v_store(out + at, sums[j] + carry + vx_load(above + at));
                if ((i + j + 1) * pixelsInVector % 4 == 0)
                    carry = carry + repeatLastFour(sums[j]);
            }
        }
    }
}

//! For 16-bit images. A pixel is one 128-bit vector, on every machine.
void sumRowOf16Bit(const int* const planes[GROUP_CHANNELS], int width, const unsigned* above, unsigned* out)
{
    v_uint32x4 sum = v_setzero_u32();
    for (int x = 0; x < width; x++)
    {
        sum = sum + v_uint32x4((unsigned)planes[0][x], (unsigned)planes[1][x], (unsigned)planes[2][x],
                            (unsigned)planes[3][x]);
        v_store(out + 4 * (x + 1), sum + v_load(above + 4 * (x + 1)));
    }
}

template <typename T> RowKernels<T> rowKernels() { return {imageChannelRows<T>, widenRow, widenRow}; }

}  // namespace
CV_CPU_OPTIMIZATION_NAMESPACE_END
}}  // namespace cv::iib
