// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#include "../precomp.hpp"

namespace cv { namespace iib {
CV_CPU_OPTIMIZATION_NAMESPACE_BEGIN
void greyRows(const Mat& image, Mat& grey, const Range& rows);
CV_CPU_OPTIMIZATION_NAMESPACE_END
}}  // namespace cv::iib

#ifndef CV_CPU_OPTIMIZATION_DECLARATIONS_ONLY

#include "vectors.simd.hpp"

namespace cv { namespace iib {
CV_CPU_OPTIMIZATION_NAMESPACE_BEGIN
namespace {

constexpr int BLUE = 3735, GREEN = 19235, RED = 9798, SHIFT = 15;  // as 15-bit fractions their sum is 1

//! The grey of half a vector of pixels below 2^15. @param redHalf pairs of red and 1; the 1 is for rounding.
inline v_uint32 weighted(const v_int16& blueGreen, const v_int16& redHalf)
{
    const v_int32 first = v_reinterpret_as_s32(vx_setall_u32((unsigned)GREEN << 16 | BLUE)),
                  second = v_reinterpret_as_s32(vx_setall_u32((unsigned)1 << (SHIFT - 1 + 16) | RED));
    return v_reinterpret_as_u32(v_dotprod(blueGreen, v_reinterpret_as_s16(first)) +
                                v_dotprod(redHalf, v_reinterpret_as_s16(second))) >>
           SHIFT;
}

inline v_uint16 weighted(const v_uint16& b, const v_uint16& g, const v_uint16& r)
{
    v_uint16 bg[2], rh[2];
    v_zip(b, g, bg[0], bg[1]);
    v_zip(r, vx_setall_u16(1), rh[0], rh[1]);
    v_uint32 halves[2];
    for (int i = 0; i < 2; i++)
        halves[i] = weighted(v_reinterpret_as_s16(bg[i]), v_reinterpret_as_s16(rh[i]));
    return v_pack(halves[0], halves[1]);
}

inline void storeGrey(const v_uint8& b, const v_uint8& g, const v_uint8& r, uchar* out)
{
    v_uint16 bs[2], gs[2], rs[2];
    v_expand(b, bs[0], bs[1]);
    v_expand(g, gs[0], gs[1]);
    v_expand(r, rs[0], rs[1]);
    v_store(out, v_pack(weighted(bs[0], gs[0], rs[0]), weighted(bs[1], gs[1], rs[1])));
}

inline void storeGrey(const v_uint16& b, const v_uint16& g, const v_uint16& r, ushort* out)
{
    v_uint32 bs[2], gs[2], rs[2], sums[2];
    v_expand(b, bs[0], bs[1]);
    v_expand(g, gs[0], gs[1]);
    v_expand(r, rs[0], rs[1]);
    for (int i = 0; i < 2; i++)
        sums[i] = (bs[i] * vx_setall_u32(BLUE) + gs[i] * vx_setall_u32(GREEN) + rs[i] * vx_setall_u32(RED) +
                          vx_setall_u32(1 << (SHIFT - 1))) >>
                  SHIFT;
    v_store(out, v_pack(sums[0], sums[1]));
}

inline v_uint8 vectorOf(uchar) { return v_uint8(); }
inline v_uint16 vectorOf(ushort) { return v_uint16(); }

template <int CHANNELS, typename T> void greyRow(const T* in, T* out, int width)
{
    typedef decltype(vectorOf(T())) V;
    constexpr int N = VTraits<V>::max_nlanes;
    const auto vector = [&](int x) {
        V b, g, r, a;
        if (CHANNELS == 3)
            v_load_deinterleave(in + 3 * x, b, g, r);
        else
            v_load_deinterleave(in + 4 * x, b, g, r, a);
        storeGrey(b, g, r, out + x);
    };
    for (int x = 0; x <= width - N; x += N)
        vector(x);
    if (width >= N)
        return vector(width - N);  // may overlap the vector before
    for (int x = 0; x < width; x++, in += CHANNELS)
        out[x] = (T)(((unsigned)in[0] * BLUE + (unsigned)in[1] * GREEN + (unsigned)in[2] * RED +
                             (1 << (SHIFT - 1))) >>
                     SHIFT);
}

template <typename T> void greyRowsOf(const Mat& image, Mat& grey, const Range& rows)
{
    const auto row = image.channels() == 3 ? greyRow<3, T> : greyRow<4, T>;
    for (int y = rows.start; y < rows.end; y++)
        row(image.ptr<T>(y), grey.ptr<T>(y), image.cols);
}

}  // namespace

void greyRows(const Mat& image, Mat& grey, const Range& rows)
{
    (image.depth() == CV_8U ? greyRowsOf<uchar> : greyRowsOf<ushort>)(image, grey, rows);
}

CV_CPU_OPTIMIZATION_NAMESPACE_END
}}  // namespace cv::iib

#endif
