// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#pragma once

#include "../../common/vectors.simd.hpp"

// Vector operations of the descriptor's kernels alone, with raw intrinsics.

namespace cv { namespace iib {
CV_CPU_OPTIMIZATION_NAMESPACE_BEGIN
namespace {

/* Comparison, and moves between lanes. */

//! `whole` - v where a < b, else v.
template <typename V> inline V subtractWhereLess(const V& a, const V& b, const V& whole, const V& v)
{
    return v_select(a < b, whole - v, v);
}

#if CV_AVX512_SKX  // v_select would convert masks to vectors and back
inline v_int16 subtractWhereLess(const v_int16& a, const v_int16& b, const v_int16& whole, const v_int16& v)
{
    return v_int16(_mm512_mask_sub_epi16(v.val, _mm512_cmplt_epi16_mask(a.val, b.val), whole.val, v.val));
}
#endif

/* Interleaves four planes; out[0] gets the first pixels. Zipping is cheap only within 128 bits, so wider vectors are permuted
 first. */
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

//! The values eight lanes further on. NEON has no rotation by a whole vector. @param next the vector behind `values`.
inline v_int16 eightBehind(const v_int16& values, const v_int16& next)
{
#if CV_AVX2
    return v_rotate_right<8>(values, next);
#else
    (void)values;
    return next;
#endif
}

/* Stores groups of four lanes, every other one to `even` and to `odd`; `lane` counts the lanes that were stored before,
 and a vector may be as small as one. */
inline void storeAlternately(unsigned* even, unsigned* odd, int lane, const v_int32& v)
{
    const v_uint32 u = v_reinterpret_as_u32(v);
#if CV_AVX512_SKX
    const v_uint32 sorted(_mm512_shuffle_i32x4(u.val, u.val, 0xd8));  // groups 0, 2, 1, 3
    v_store_low(even + lane / 2, sorted);
    v_store_high(odd + lane / 2, sorted);
#elif CV_AVX2
    v_store_low(even + lane / 2, u);
    v_store_high(odd + lane / 2, u);
#else
    v_store((lane % 8 < 4 ? even : odd) + lane / 8 * 4, u);
#endif
}

/* Repeats each of four numbers four times, in 16 / (lanes of v_int32) vectors. Not through memory: a vector load would wait for
 the stores of its parts. */
inline void repeatEachFourTimes(const v_int32x4& n, v_int32 out[])
{
#if CV_AVX512_SKX
    const __m512i places = _mm512_setr_epi32(0, 0, 0, 0, 1, 1, 1, 1, 2, 2, 2, 2, 3, 3, 3, 3);
    out[0] = v_int32(_mm512_permutexvar_epi32(places, _mm512_castsi128_si512(n.val)));
#elif CV_AVX2
    const __m256i twice = _mm256_broadcastsi128_si256(n.val);
    out[0] = v_int32(_mm256_permutevar8x32_epi32(twice, _mm256_setr_epi32(0, 0, 0, 0, 1, 1, 1, 1)));
    out[1] = v_int32(_mm256_permutevar8x32_epi32(twice, _mm256_setr_epi32(2, 2, 2, 2, 3, 3, 3, 3)));
#else
    out[0] = v_broadcast_element<0>(n);
    out[1] = v_broadcast_element<1>(n);
    out[2] = v_broadcast_element<2>(n);
    out[3] = v_broadcast_element<3>(n);
#endif
}

inline void storeAlternately(double* even, double* odd, int lane, const v_doubles& v)
{
#if CV_AVX512_SKX
    v_store_low(even + lane / 2, v);
    v_store_high(odd + lane / 2, v);
#else
    v_store((lane % 8 < 4 ? even : odd) + lane / 8 * 4 + lane % 4, v);
#endif
}

/* Pixels and sums from several places. */

/* A group is the four channels of a pixel. loadGroups() loads groups from several places into one vector, nextGroups()
 shifts a vector by one group. Vectors have 256 bits at most: the offsets of a 512-bit one need too many registers.
 v_lut_quads is not used, since gather instructions are slow on many machines. */
#if CV_AVX2
typedef v_uint16x16 v_groups16;
typedef v_uint32x8 v_groups32;

//! Four places: row + at[0], at[2], at[4], at[6].
inline v_groups16 loadGroups(const ushort* row, const size_t* at)
{
    const __m128i low = v_load_halves(row + at[0], row + at[2]).val;
    return v_groups16(_mm256_inserti128_si256(
            _mm256_castsi128_si256(low), v_load_halves(row + at[4], row + at[6]).val, 1));
}

//! Two places: row + at[0], at[2].
inline v_groups32 loadGroups(const unsigned* row, const size_t* at)
{
    const __m256i low = _mm256_castsi128_si256(v_load(row + at[0]).val);
    return v_groups32(_mm256_inserti128_si256(low, v_load(row + at[2]).val, 1));
}

//! Drops the first group and appends the one at `more`.
inline v_groups16 nextGroups(const v_groups16& v, const ushort* more)
{
    return v_rotate_right<4>(v, v_groups16(_mm256_castsi128_si256(v_load_low(more).val)));
}

inline v_groups32 nextGroups(const v_groups32& v, const unsigned* more)
{
    return v_rotate_right<4>(v, v_groups32(_mm256_castsi128_si256(v_load(more).val)));
}
#else
typedef v_uint16x8 v_groups16;
typedef v_uint32x4 v_groups32;

//! Two places: row + at[0], at[2].
inline v_groups16 loadGroups(const ushort* row, const size_t* at)
{
    return v_load_halves(row + at[0], row + at[2]);
}

//! One place: row + at[0].
inline v_groups32 loadGroups(const unsigned* row, const size_t* at) { return v_load(row + at[0]); }

//! Drops the first group and appends the one at `more`.
inline v_groups16 nextGroups(const v_groups16& v, const ushort* more)
{
    return v_rotate_right<4>(v, v_groups16(v_load_low(more)));
}

inline v_groups32 nextGroups(const v_groups32&, const unsigned* more) { return v_load(more); }
#endif

/* Pixels of four values from anywhere: loadPixels() loads as many as v_samples has lanes, at
 these indices, and takes their values apart. */
#if CV_AVX2
inline void loadPixels(
        const short* pixels, const int* i, v_samples& a, v_samples& b, v_samples& c, v_samples& d)
{
    const auto twoPixels = [&](int k) {
        return v_load_halves(pixels + (size_t)4 * i[k], pixels + (size_t)4 * i[k + 1]).val;
    };
    const __m256i even = _mm256_inserti128_si256(_mm256_castsi128_si256(twoPixels(0)), twoPixels(4), 1);
    const __m256i odd = _mm256_inserti128_si256(_mm256_castsi128_si256(twoPixels(2)), twoPixels(6), 1);
    // pairs of values: the first two of each pixel, and the last two
    const __m256 e = _mm256_castsi256_ps(even), o = _mm256_castsi256_ps(odd);
    const __m256i first = _mm256_castps_si256(_mm256_shuffle_ps(e, o, 0x88));
    const __m256i last = _mm256_castps_si256(_mm256_shuffle_ps(e, o, 0xdd));
    a = v_samples(_mm256_srai_epi32(_mm256_slli_epi32(first, 16), 16));
    b = v_samples(_mm256_srai_epi32(first, 16));
    c = v_samples(_mm256_srai_epi32(_mm256_slli_epi32(last, 16), 16));
    d = v_samples(_mm256_srai_epi32(last, 16));
}

inline void loadPixels(
        const int* pixels, const int* i, v_samples& a, v_samples& b, v_samples& c, v_samples& d)
{
    v_int32x4 v[4], low[4], high[4];
    for (int k = 0; k < 4; k++)
        v[k] = v_load(pixels + (size_t)4 * i[k]);
    v_transpose4x4(v[0], v[1], v[2], v[3], low[0], low[1], low[2], low[3]);
    for (int k = 0; k < 4; k++)
        v[k] = v_load(pixels + (size_t)4 * i[4 + k]);
    v_transpose4x4(v[0], v[1], v[2], v[3], high[0], high[1], high[2], high[3]);
    v_samples* const out[] = {&a, &b, &c, &d};
    for (int k = 0; k < 4; k++)
        *out[k] = v_samples(_mm256_inserti128_si256(_mm256_castsi128_si256(low[k].val), high[k].val, 1));
}
#else
inline v_int32x4 loadPixel(const short* p) { return v_load_expand(p); }
inline v_int32x4 loadPixel(const int* p) { return v_load(p); }

template <typename T>
inline void loadPixels(const T* pixels, const int* i, v_samples& a, v_samples& b, v_samples& c, v_samples& d)
{
    v_int32x4 v0 = loadPixel(pixels + (size_t)4 * i[0]), v1 = loadPixel(pixels + (size_t)4 * i[1]),
              v2 = loadPixel(pixels + (size_t)4 * i[2]), v3 = loadPixel(pixels + (size_t)4 * i[3]);
    v_transpose4x4(v0, v1, v2, v3, a, b, c, d);
}
#endif

#if IIB_SUMS_SEGMENTS
//! Sums over eight segments of a row that follow each other, of four rows at once.
class SegmentSums
{
public:
    static constexpr int COUNT = 8;
    static constexpr int LONGEST = 4;  //!< at most this many values of a segment are summed
    static constexpr int REACH = 32;   //!< all segments have to lie within this many values

    //! @param edges COUNT + 1 of them, where the segments begin and end.
    explicit SegmentSums(const int* edges)
    {
        const __m256i first = _mm256_set1_epi32(edges[0]);
        const __m256i begin = _mm256_sub_epi32(_mm256_loadu_si256((const __m256i*)edges), first);
        const __m256i end = _mm256_sub_epi32(_mm256_loadu_si256((const __m256i*)(edges + 1)), first);
        const __m256i reached = _mm256_min_epi32(
                _mm256_add_epi32(begin, _mm256_set1_epi32(LONGEST)), _mm256_set1_epi32(REACH));
        complete = _mm256_cmpgt_epi32_mask(end, reached) == 0;

        const __m512i places = _mm512_add_epi16(
                fourTimes(begin), _mm512_set_epi64(0x0003000300030003, 0x0003000300030003, 0x0002000200020002,
                                          0x0002000200020002, 0x0001000100010001, 0x0001000100010001, 0, 0));
        const __m512i index = _mm512_add_epi16(
                _mm512_mullo_epi16(places, _mm512_set1_epi16(0x0202)), _mm512_set1_epi16(0x0100));
        const __m512i within =
                _mm512_movm_epi16(_mm512_cmplt_epi16_mask(places, fourTimes(_mm256_min_epi32(end, reached))));
        // the quarters of a vector hold the first values, the second ... of each segment, in an order for each row
        picked[0] = Picked{index, _mm512_movepi8_mask(within)};
        picked[1] = picked[0].ordered<0x4e>(within);
        picked[2] = picked[0].ordered<0xb1>(within);
        picked[3] = picked[0].ordered<0x1b>(within);
    }

    //! Whether each segment is summed whole.
    bool areComplete() const { return complete; }

    //! The end of the summed part of segment i.
    static int reached(const int* edges, int i)
    {
        return std::max(std::min(edges[i] + LONGEST, edges[0] + REACH), edges[i]);
    }

    //! The sums modulo 2^16, first those of row + at[0].
    v_uint16 operator()(const ushort* row, const size_t at[4]) const
    {
        const __m512i a = pick(0, row + at[0]), b = pick(1, row + at[1]), c = pick(2, row + at[2]),
                      d = pick(3, row + at[3]);
        const __m512i ab =
                _mm512_add_epi16(_mm512_mask_blend_epi64(0xf0, a, b), _mm512_shuffle_i64x2(a, b, 0x4e));
        const __m512i cd =
                _mm512_add_epi16(_mm512_mask_blend_epi64(0xf0, c, d), _mm512_shuffle_i64x2(c, d, 0x4e));
        const __m512i rest = _mm512_mask_blend_epi64(0x33, ab, cd);
        return v_uint16(_mm512_add_epi16(
                _mm512_mask_blend_epi64(0xcc, ab, cd), _mm512_shuffle_i64x2(rest, rest, 0xb1)));
    }

    //! Stores the sums of segments 0, 2, 4, 6 to `even`, the others to `odd`, interleaved by rows.
    static void store(ushort* even, ushort* odd, const v_uint16& sums)
    {
        const __m512i bytes = _mm512_set_epi64(0x3f3e1f1e2f2e0f0e, 0x3b3a1b1a2b2a0b0a, 0x3736171627260706,
                0x3332131223220302, 0x3d3c1d1c2d2c0d0c, 0x3938191829280908, 0x3534151425240504,
                0x3130111021200100);
        const v_uint16 sorted(_mm512_permutexvar_epi8(bytes, sums.val));
        v_store_low(even, sorted);
        v_store_high(odd, sorted);
    }

private:
    struct Picked
    {
        __m512i index;
        __mmask64 within;

        template <int ORDER> Picked ordered(const __m512i& bytesWithin) const
        {
            return Picked{_mm512_shuffle_i64x2(index, index, ORDER),
                    _mm512_movepi8_mask(_mm512_shuffle_i64x2(bytesWithin, bytesWithin, ORDER))};
        }
    };

    static __m512i fourTimes(const __m256i& v) { return _mm512_broadcast_i32x4(_mm256_cvtepi32_epi16(v)); }

    __m512i pick(int i, const ushort* p) const
    {
        return _mm512_maskz_permutexvar_epi8(picked[i].within, picked[i].index, _mm512_loadu_si512(p));
    }

    Picked picked[4];
    bool complete;
};
#endif

}  // namespace
CV_CPU_OPTIMIZATION_NAMESPACE_END
}}  // namespace cv::iib
