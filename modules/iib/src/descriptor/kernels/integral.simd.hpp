// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#ifndef OPENCV_IIB_DESCRIPTOR_KERNELS_INTEGRAL_SIMD_HPP
#define OPENCV_IIB_DESCRIPTOR_KERNELS_INTEGRAL_SIMD_HPP

#include "../../common/vectors.hpp"
#include "kernels.hpp"

namespace cv {
namespace iib {

CV_CPU_OPTIMIZATION_NAMESPACE_BEGIN

namespace {

/* Interleaves four planes; out[0] gets the first pixels. Zipping is cheap only within 128 bits, so that wider vectors are
 first permuted. */
inline void interleaveFour(const v_uint16 planes[4], v_uint16 out[4])
{
#if CV_AVX512_SKX
    const __m512i places = _mm512_setr_epi32(0, 4, 8, 12, 1, 5, 9, 13, 2, 6, 10, 14, 3, 7, 11, 15);
    __m512i p[4];
    for (int i = 0; i < 4; i++)
        p[i] = _mm512_permutexvar_epi32(places, planes[i].val);
    const __m512i low01 = _mm512_unpacklo_epi16(p[0], p[1]), high01 = _mm512_unpackhi_epi16(p[0], p[1]);
    const __m512i low23 = _mm512_unpacklo_epi16(p[2], p[3]), high23 = _mm512_unpackhi_epi16(p[2], p[3]);
    out[0] = v_uint16(_mm512_unpacklo_epi32(low01, low23));
    out[1] = v_uint16(_mm512_unpackhi_epi32(low01, low23));
    out[2] = v_uint16(_mm512_unpacklo_epi32(high01, high23));
    out[3] = v_uint16(_mm512_unpackhi_epi32(high01, high23));
#elif CV_AVX2
    const __m256i places = _mm256_setr_epi32(0, 2, 4, 6, 1, 3, 5, 7);
    __m256i p[4];
    for (int i = 0; i < 4; i++)
        p[i] = _mm256_permutevar8x32_epi32(planes[i].val, places);
    const __m256i low01 = _mm256_unpacklo_epi16(p[0], p[1]), high01 = _mm256_unpackhi_epi16(p[0], p[1]);
    const __m256i low23 = _mm256_unpacklo_epi16(p[2], p[3]), high23 = _mm256_unpackhi_epi16(p[2], p[3]);
    out[0] = v_uint16(_mm256_unpacklo_epi32(low01, low23));
    out[1] = v_uint16(_mm256_unpackhi_epi32(low01, low23));
    out[2] = v_uint16(_mm256_unpacklo_epi32(high01, high23));
    out[3] = v_uint16(_mm256_unpackhi_epi32(high01, high23));
#else
    v_uint16 low01, high01, low23, high23;
    v_zip(planes[0], planes[1], low01, high01);
    v_zip(planes[2], planes[3], low23, high23);
    v_uint32 pixels[4];
    v_zip(v_reinterpret_as_u32(low01), v_reinterpret_as_u32(low23), pixels[0], pixels[1]);
    v_zip(v_reinterpret_as_u32(high01), v_reinterpret_as_u32(high23), pixels[2], pixels[3]);
    for (int i = 0; i < 4; i++)
        out[i] = v_reinterpret_as_u16(pixels[i]);
#endif
}

//! Adds to each value those before it in its group of four, modulo 2^16.
inline v_uint16 prefixSumsOfFour(const v_uint16& v)
{
    // Added in 16 bits: valgrind takes a whole 64-bit sum for undefined where the last pixels of four are.
    const v_uint16 two = v_add_wrap(v, v_reinterpret_as_u16(v_reinterpret_as_u64(v) << 16));
    return v_add_wrap(two, v_reinterpret_as_u16(v_reinterpret_as_u64(two) << 32));
}

//! In vectors of 512 bits, adds the fourth 64-bit element to the four after it, in 16-bit lanes.
inline v_uint16 addFourthToUpper(const v_uint16& v)
{
#if CV_AVX512_SKX
    return v_uint16(
            _mm512_add_epi16(v.val, _mm512_maskz_permutexvar_epi64(0xf0, _mm512_set1_epi64(3), v.val)));
#else
    return v;
#endif
}

//! Repeats the last four values; universal intrinsics have this for 128 bits only.
inline v_uint16 repeatLastFour(const v_uint16& v)
{
#if CV_AVX512_SKX
    return v_uint16(_mm512_permutexvar_epi64(_mm512_set1_epi64(7), v.val));
#elif CV_AVX2
    return v_uint16(_mm256_permute4x64_epi64(v.val, 0xff));
#else
    return v_combine_high(v, v);
#endif
}

inline v_uint32 repeatLastFour(const v_uint32& v)
{
#if CV_AVX512_SKX
    return v_uint32(_mm512_shuffle_i32x4(v.val, v.val, 0xff));
#elif CV_AVX2
    return v_uint32(_mm256_permute2x128_si256(v.val, v.val, 0x11));
#else
    return v;
#endif
}

//! Running sums within each four pixels of a plane, from pixel x on.
inline v_uint16 loadSums(const short* plane, int x)
{
    return prefixSumsOfFour(v_reinterpret_as_u16(vx_load(plane + x)));
}

//! The same of four planes, interleaved.
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

//! Of 16-bit images, whose sums over four pixels exceed 16 bits. A pixel is one 128-bit vector here, on every machine.
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

}  // namespace

CV_CPU_OPTIMIZATION_NAMESPACE_END

}  // namespace iib
}  // namespace cv

#endif
