// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#ifndef OPENCV_IIB_DESCRIPTOR_KERNELS_CHANNEL_ROWS_SIMD_HPP
#define OPENCV_IIB_DESCRIPTOR_KERNELS_CHANNEL_ROWS_SIMD_HPP

#include "../../common/simd.hpp"
#include "kernels.hpp"
#include "orientation.hpp"

namespace cv {
namespace iib {

CV_CPU_OPTIMIZATION_NAMESPACE_BEGIN

namespace {

inline v_int16 absolute(const v_int16& v) { return v_reinterpret_as_s16(v_abs(v)); }

inline v_int32 absolute(const v_int32& v) { return v_reinterpret_as_s32(v_abs(v)); }

inline v_int16 setAll(short v) { return vx_setall_s16(v); }
inline v_int32 setAll(int v) { return vx_setall_s32(v); }

//! ORIENTATION_STEPS / 8 steps for equal sides; lo <= hi, hi > 0.
inline v_int32 octantSteps(const v_int32& lo, const v_int32& hi)
{
    const v_float32 t = exactQuotient(v_cvt_f32(lo), v_cvt_f32(hi)), t2 = t * t;
    const v_float32 a = vx_setall_f32(ATAN_A), b = vx_setall_f32(ATAN_B), c = vx_setall_f32(ATAN_C);
    return nearestInt(((c * t2 + b) * t2 + a) * t);
}

//! Even and odd lanes apart, which takes no shuffle; lanes are 0 or greater.
inline v_int16 octantSteps(const v_int16& lo, const v_int16& hi)
{
    const v_int32 low = vx_setall_s32(0xffff), lo2 = v_reinterpret_as_s32(lo), hi2 = v_reinterpret_as_s32(hi);
    const v_int32 even = octantSteps(lo2 & low, hi2 & low), odd = octantSteps(lo2 >> 16, hi2 >> 16);
    return v_reinterpret_as_s16(even | (odd << 16));
}

template <typename T, typename V> inline V orientation(const V& gx, const V& gy)
{
    const V ax = absolute(gx), ay = absolute(gy);
    V s = octantSteps(v_min(ax, ay), v_max(v_max(ax, ay), setAll((T)1)));
    s = subtractWhereNegative(ax - ay, setAll((T)(ORIENTATION_STEPS / 4)), s);
    s = subtractWhereNegative(gx, setAll((T)(ORIENTATION_STEPS / 2)), s);
    s = subtractWhereNegative(setAll((T)0) - gy, setAll((T)ORIENTATION_STEPS), s);
    return s & setAll((T)(ORIENTATION_STEPS - 1));
}

template <typename T> void orientationRow(const T* gx, const T* gy, T* steps, int width)
{
    for (int x = 0; x < width; x += VTraits<decltype(setAll(T()))>::max_nlanes)
        v_store(steps + x, orientation<T>(vx_load(gx + x), vx_load(gy + x)));
}

template <typename T>
void imageChannelRows(
        const T* above, const T* middle, const T* below, T signedOffset, ImageChannelRows<T> out, int width)
{
    typedef decltype(setAll(T())) V;
    const V offset = setAll(signedOffset);
    for (int x = 0; x < width; x += VTraits<V>::max_nlanes)
    {
        const V a0 = vx_load(above + x), a1 = vx_load(above + x + 1), a2 = vx_load(above + x + 2);
        const V m0 = vx_load(middle + x), m2 = vx_load(middle + x + 2);
        const V b0 = vx_load(below + x), b1 = vx_load(below + x + 1), b2 = vx_load(below + x + 2);
        const V dm = m2 - m0, d0 = b0 - a0, d1 = b1 - a1, d2 = b2 - a2;
        const V gx = ((a2 - a0) + (b2 - b0)) + (dm + dm), gy = (d0 + d2) + (d1 + d1);
        if (out.pixels)
            v_store(out.pixels + x, vx_load(middle + x + 1));
        if (out.x)
            v_store(out.x + x, gx + offset);
        if (out.y)
            v_store(out.y + x, gy + offset);
        if (out.absoluteX)
            v_store(out.absoluteX + x, absolute(gx));
        if (out.absoluteY)
            v_store(out.absoluteY + x, absolute(gy));
        if (out.steps)
            v_store(out.steps + x, orientation<T>(gx, gy));
    }
}

void widenRow(const uchar* in, short* out, int width)
{
    int x = 0;
    for (; x <= width - VTraits<v_int16>::max_nlanes; x += VTraits<v_int16>::max_nlanes)
        v_store(out + x, v_reinterpret_as_s16(vx_load_expand(in + x)));
    for (; x < width; x++)
        out[x] = in[x];
}

template <typename Pixel, typename T> void widenRow(const Pixel* in, T* out, int width)
{
    for (int x = 0; x < width; x++)
        out[x] = (T)in[x];
}

inline void storeInterleaved(short* out, const short* const planes[GROUP_CHANNELS], int x)
{
    v_store_interleave(out + GROUP_CHANNELS * x, v_load(planes[0] + x), v_load(planes[1] + x),
            v_load(planes[2] + x), v_load(planes[3] + x));
}

inline void storeInterleaved(int* out, const int* const planes[GROUP_CHANNELS], int x)
{
    for (int half = x; half < x + 8; half += 4)
        v_store_interleave(out + GROUP_CHANNELS * half, v_load(planes[0] + half), v_load(planes[1] + half),
                v_load(planes[2] + half), v_load(planes[3] + half));
}

template <typename T> void interleaveRow(const T* const planes[GROUP_CHANNELS], T* out, int width)
{
    for (int x = 0; x < width; x += 8)
        storeInterleaved(out, planes, x);
}

template <typename T> RowKernels<T> rowKernels()
{
    const RowKernels<T> k = {imageChannelRows<T>, orientationRow<T>, widenRow, widenRow, interleaveRow<T>};
    return k;
}

}  // namespace

CV_CPU_OPTIMIZATION_NAMESPACE_END

}  // namespace iib
}  // namespace cv

#endif
