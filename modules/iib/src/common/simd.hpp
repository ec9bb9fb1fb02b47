// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#ifndef OPENCV_IIB_COMMON_SIMD_HPP
#define OPENCV_IIB_COMMON_SIMD_HPP

#include "vector_operators.hpp"

namespace cv {

CV_CPU_OPTIMIZATION_HAL_NAMESPACE_BEGIN

#ifdef CV_FORCE_SIMD128_CPP
#define IIB_NATIVE_VECTORS 0
#else
#define IIB_NATIVE_VECTORS 1
#endif

/* All raw intrinsics of the library, as named primitives: for instruction sets that have a better way, and otherwise in
 universal intrinsics. */

//! A bit for each lane where the comparison holds. OpenCV's way turns AVX-512's masks into vectors and back.
#if CV_AVX512_SKX
inline unsigned greaterMask(const v_int32& a, const v_int32& b)
{
    return _mm512_cmpgt_epi32_mask(a.val, b.val);
}
inline unsigned greaterEqualMask(const v_int32& a, const v_int32& b)
{
    return _mm512_cmpge_epi32_mask(a.val, b.val);
}
inline unsigned equalMask(const v_int32& a, const v_int32& b)
{
    return _mm512_cmpeq_epi32_mask(a.val, b.val);
}
#else
inline unsigned greaterMask(const v_int32& a, const v_int32& b) { return (unsigned)v_signmask(a > b); }
inline unsigned greaterEqualMask(const v_int32& a, const v_int32& b) { return (unsigned)v_signmask(a >= b); }
inline unsigned equalMask(const v_int32& a, const v_int32& b) { return (unsigned)v_signmask(a == b); }
#endif

/* Doubles, or one of them where there are no such vectors (ARMv7, WebAssembly). */
#if CV_SIMD_64F
typedef v_float64 v_doubles;

inline v_doubles loadDoubles(const double* p) { return vx_load(p); }
inline v_doubles repeatedDouble(double v) { return vx_setall_f64(v); }
inline unsigned greaterMask(const v_doubles& a, const v_doubles& b) { return (unsigned)v_signmask(a > b); }
inline unsigned greaterEqualMask(const v_doubles& a, const v_doubles& b)
{
    return (unsigned)v_signmask(a >= b);
}
inline unsigned equalMask(const v_doubles& a, const v_doubles& b) { return (unsigned)v_signmask(a == b); }
#else
typedef double v_doubles;

template <> struct VTraits<double>
{
    static constexpr int max_nlanes = 1;
};
inline double loadDoubles(const double* p) { return *p; }
inline double repeatedDouble(double v) { return v; }
inline void v_store(double* p, double v) { *p = v; }
inline double v_min(double a, double b) { return std::min(a, b); }
inline double v_max(double a, double b) { return std::max(a, b); }
inline unsigned greaterMask(double a, double b) { return a > b; }
inline unsigned greaterEqualMask(double a, double b) { return a >= b; }
inline unsigned equalMask(double a, double b) { return a == b; }
#endif

//! The same for 16-bit lanes.
inline unsigned greaterMask(const v_int16& a, const v_int16& b)
{
#if CV_AVX512_SKX
    return _mm512_cmpgt_epi16_mask(a.val, b.val);
#else
    return (unsigned)v_signmask(a > b);
#endif
}

//! `whole` - v where a < b, v elsewhere.
inline v_int16 subtractWhereLess(const v_int16& a, const v_int16& b, const v_int16& whole, const v_int16& v)
{
#if CV_AVX512_SKX
    return v_int16(_mm512_mask_sub_epi16(v.val, _mm512_cmplt_epi16_mask(a.val, b.val), whole.val, v.val));
#else
    const v_int16 mask = a < b;  // v ^ -1 is -v - 1
    return (v ^ mask) + (mask & (whole + vx_setall_s16(1)));
#endif
}

inline v_int32 subtractWhereLess(const v_int32& a, const v_int32& b, const v_int32& whole, const v_int32& v)
{
#if CV_AVX512_SKX
    return v_int32(_mm512_mask_sub_epi32(v.val, _mm512_cmplt_epi32_mask(a.val, b.val), whole.val, v.val));
#else
    const v_int32 mask = a < b;  // v ^ -1 is -v - 1
    return (v ^ mask) + (mask & (whole + vx_setall_s32(1)));
#endif
}

//! As v_zip, of pairs of values.
inline void zipPairs(const v_uint32& a, const v_uint32& b, v_uint32& low, v_uint32& high)
{
#if CV_AVX2
    v_uint64 first, second;
    v_zip(v_reinterpret_as_u64(a), v_reinterpret_as_u64(b), first, second);
    low = v_reinterpret_as_u32(first);
    high = v_reinterpret_as_u32(second);
#else
    low = v_combine_low(a, b);
    high = v_combine_high(a, b);
#endif
}

/* Quotients, roots and nearest integers as IEEE 754 says. On ARMv7 the vectors' first two are estimates, and v_round rounds
 halves up; scalars are exact there. */
#if CV_NEON && !defined __aarch64__ && !defined _M_ARM64
inline v_float32 exactQuotient(const v_float32& a, const v_float32& b)
{
    float x[4], y[4];
    v_store(x, a);
    v_store(y, b);
    return v_float32(x[0] / y[0], x[1] / y[1], x[2] / y[2], x[3] / y[3]);
}
inline v_int32 nearestInt(const v_float32& v)
{
    float x[4];
    v_store(x, v);
    return v_int32(cvRound(x[0]), cvRound(x[1]), cvRound(x[2]), cvRound(x[3]));
}
inline v_float32 exactRoot(const v_float32& v)
{
    float x[4];
    v_store(x, v);
    return v_float32(std::sqrt(x[0]), std::sqrt(x[1]), std::sqrt(x[2]), std::sqrt(x[3]));
}
#else
inline v_float32 exactQuotient(const v_float32& a, const v_float32& b) { return a / b; }
template <typename V> inline auto nearestInt(const V& v) -> decltype(v_round(v)) { return v_round(v); }
template <typename V> inline V exactRoot(const V& v) { return v_sqrt(v); }
#endif

/* Four planes side by side: out[0] gets the first pixels. To zip within 128 bits is cheap, across a wider vector it is not:
 pairs of pixels are first put where that brings neighbours together. */
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

//! Where a vector has more than four 64-bit elements, adds the fourth to those after it, in 16-bit lanes.
inline v_uint16 addFourthToUpper(const v_uint16& v)
{
#if CV_AVX512_SKX
    return v_uint16(
            _mm512_add_epi16(v.val, _mm512_maskz_permutexvar_epi64(0xf0, _mm512_set1_epi64(3), v.val)));
#else
    return v;
#endif
}

//! The last four values in the places of all; universal intrinsics have this for 128 bits only.
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

/* Stores groups of four lanes, every other one to `even` and to `odd`; `lane` counts the lanes that were stored before, and
 a vector may be as small as one. */
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

inline void storeAlternately(double* even, double* odd, int lane, const v_doubles& v)
{
#if CV_AVX512_SKX
    v_store_low(even + lane / 2, v);
    v_store_high(odd + lane / 2, v);
#else
    v_store((lane % 8 < 4 ? even : odd) + lane / 8 * 4 + lane % 4, v);
#endif
}

/* Four numbers, each repeated four times, as 16 / v_int32 lanes vectors. Not by way of memory, where what was stored in
 parts could not be read whole until all stores before it are done. */
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

/* Groups of four values from several places side by side, and a vector of them moved on by one group. A vector of 256
 bits at most: the offsets of a whole 512-bit one are too many for the registers. Not v_lut_quads: gather instructions
 are slow on many machines. */
#if CV_AVX2
typedef v_uint16x16 v_groups16;
typedef v_uint32x8 v_groups32;

inline __m128i twoGroups(const ushort* first, const ushort* second)
{
    return _mm_castpd_si128(_mm_loadh_pd(_mm_load_sd((const double*)first), (const double*)second));
}

//! Four places: row + at[0], at[2], at[4], at[6].
inline v_groups16 loadGroups(const ushort* row, const size_t* at)
{
#if CV_AVX512_SKX
    __m256i v = _mm256_castsi128_si256(_mm_loadl_epi64((const __m128i*)(row + at[0])));
    v = _mm256_mask_broadcastq_epi64(v, 2, _mm_loadl_epi64((const __m128i*)(row + at[2])));
    v = _mm256_mask_broadcastq_epi64(v, 4, _mm_loadl_epi64((const __m128i*)(row + at[4])));
    return v_groups16(_mm256_mask_broadcastq_epi64(v, 8, _mm_loadl_epi64((const __m128i*)(row + at[6]))));
#else
    const __m128i low = twoGroups(row + at[0], row + at[2]), high = twoGroups(row + at[4], row + at[6]);
    return v_groups16(_mm256_inserti128_si256(_mm256_castsi128_si256(low), high, 1));
#endif
}

//! Two places: row + at[0], at[2].
inline v_groups32 loadGroups(const unsigned* row, const size_t* at)
{
    const __m256i low = _mm256_castsi128_si256(v_load(row + at[0]).val);
    return v_groups32(_mm256_inserti128_si256(low, v_load(row + at[2]).val, 1));
}

//! Without the first group, and with the one at `more` behind the last.
inline v_groups16 nextGroups(const v_groups16& v, const ushort* more)
{
    const __m256i next = _mm256_castsi128_si256(v_load_low(more).val);
#if CV_AVX512_SKX
    return v_groups16(_mm256_alignr_epi64(next, v.val, 1));
#else
    return v_rotate_right<4>(v, v_groups16(next));
#endif
}

inline v_groups32 nextGroups(const v_groups32& v, const unsigned* more)
{
    const __m256i next = _mm256_castsi128_si256(v_load(more).val);
#if CV_AVX512_SKX
    return v_groups32(_mm256_alignr_epi64(next, v.val, 2));
#else
    return v_rotate_right<4>(v, v_groups32(next));
#endif
}

inline v_groups16 subtractModulo(const v_groups16& a, const v_groups16& b) { return v_sub_wrap(a, b); }
inline v_groups32 subtractModulo(const v_groups32& a, const v_groups32& b) { return a - b; }
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

//! Without the first group, and with the one at `more` behind the last.
inline v_groups16 nextGroups(const v_groups16& v, const ushort* more)
{
    return v_rotate_right<4>(v, v_groups16(v_load_low(more)));
}

inline v_groups32 nextGroups(const v_groups32&, const unsigned* more) { return v_load(more); }

inline v_groups16 subtractModulo(const v_groups16& a, const v_groups16& b) { return v_sub_wrap(a, b); }
inline v_groups32 subtractModulo(const v_groups32& a, const v_groups32& b) { return a - b; }
#endif

/* Sums over eight segments of a row that follow each other, of four rows at once, where one instruction picks bytes out
 of a whole vector; a macro says whether that is so. */
#if CV_AVX512_ICL && IIB_NATIVE_VECTORS
#define IIB_SUMS_SEGMENTS 1
class SegmentSums
{
public:
    static constexpr int COUNT = 8;
    static constexpr int LONGEST = 4;  //!< values of a segment that are summed: the first ones,
    static constexpr int REACH = 32;   //!< and only those among so many first ones of all segments

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

    //! The end of what is summed of segment i.
    static int reached(const int* edges, int i)
    {
        return std::max(std::min(edges[i] + LONGEST, edges[0] + REACH), edges[i]);
    }

    //! The sums, those of row + at[0] first, modulo 2^16.
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

    //! Stores those of segments 0, 2, 4, 6 to `even`, all rows' of one side by side, and the others to `odd`.
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
#else
#define IIB_SUMS_SEGMENTS 0
#endif

/* Pixels of four values from anywhere: loadPixels() loads as many as v_samples has lanes, at
 these indices, and takes their values apart. */
#if CV_AVX2
typedef v_int32x8 v_samples;

typedef v_float32x8 v_means;

inline v_samples v_load_samples(const int* p) { return v256_load(p); }
inline v_samples v_load_samples(const short* p) { return v256_load_expand(p); }
inline v_samples v_setall_samples(int v) { return v256_setall_s32(v); }
inline v_means v_load_means(const float* p) { return v256_load(p); }
inline v_means v_setall_means(float v) { return v256_setall_f32(v); }

inline void loadPixels(
        const short* pixels, const int* i, v_samples& a, v_samples& b, v_samples& c, v_samples& d)
{
    const ushort* const p = reinterpret_cast<const ushort*>(pixels);
    __m256i even = _mm256_castsi128_si256(twoGroups(p + (size_t)4 * i[0], p + (size_t)4 * i[1]));
    __m256i odd = _mm256_castsi128_si256(twoGroups(p + (size_t)4 * i[2], p + (size_t)4 * i[3]));
    even = _mm256_inserti128_si256(even, twoGroups(p + (size_t)4 * i[4], p + (size_t)4 * i[5]), 1);
    odd = _mm256_inserti128_si256(odd, twoGroups(p + (size_t)4 * i[6], p + (size_t)4 * i[7]), 1);
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
typedef v_int32x4 v_samples;

typedef v_float32x4 v_means;

inline v_samples v_load_samples(const int* p) { return v_load(p); }
inline v_samples v_load_samples(const short* p) { return v_load_expand(p); }
inline v_samples v_setall_samples(int v) { return v_setall_s32(v); }
inline v_means v_load_means(const float* p) { return v_load(p); }
inline v_means v_setall_means(float v) { return v_setall_f32(v); }

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

//! Products of values and a factor that fit 16 bits; `factor` comes from sampleFactor(). Whole 32-bit products are slow.
inline v_samples sampleFactor(short factor) { return v_setall_samples((int)(ushort)factor); }
inline v_samples sampleFactor(int factor) { return v_setall_samples(factor); }
inline v_samples multiplySamples(const v_samples& v, const v_samples& factor, short)
{
    return v_dotprod(v_reinterpret_as_s16(v), v_reinterpret_as_s16(factor));
}
inline v_samples multiplySamples(const v_samples& v, const v_samples& factor, int) { return v * factor; }

/* Moves the bits of a mask together, to the low end. Processors with AVX-512 have a fast instruction for it; among those
 with AVX2 are some where it is slower than a dozen shifts. */
#if CV_AVX512_SKX && (defined __x86_64__ || defined _M_X64)
#define IIB_HAS_FAST_BIT_COMPRESS 1
#ifdef __GNUC__
#define IIB_TARGET_BIT_COMPRESS __attribute__((target("bmi2")))
#else
#define IIB_TARGET_BIT_COMPRESS
#endif
IIB_TARGET_BIT_COMPRESS inline uint64 compressBits(uint64 bits, uint64 mask) { return _pext_u64(bits, mask); }
/* To be called before a function that has this target: where one is the last that its caller calls, GCC 12 leaves the upper
 halves of vectors in use, and all code without AVX that follows, also of the library's user, runs at half the speed. */
inline void freeUpperHalves() { _mm256_zeroupper(); }
#else
#define IIB_HAS_FAST_BIT_COMPRESS 0
#define IIB_TARGET_BIT_COMPRESS
#endif

/* For the matcher. Each primitive is chosen by instruction set, never by the width of vectors, which different
 architectures share; where there is no portable form, a macro says whether it exists. */

//! Number of set bits.
inline int countBits(unsigned word)
{
#if CV_POPCNT
    return _mm_popcnt_u32(word);
#else
    int count = 0;
    for (; word; word &= word - 1)
        count++;
    return count;
#endif
}

// Counts the bits of 64-bit words by one instruction.
#if CV_POPCNT && (defined __x86_64__ || defined _M_X64)
#define IIB_COUNTS_64_BITS 1
inline int countBits64(uint64 word) { return (int)_mm_popcnt_u64(word); }
#else
#define IIB_COUNTS_64_BITS 0
#endif

// v_popcount(v_uint32) is one instruction; elsewhere counting bytes is cheaper.
#if CV_AVX512_ICL && IIB_NATIVE_VECTORS
#define IIB_COUNTS_LANES 1
#else
#define IIB_COUNTS_LANES 0
#endif

//! A full adder of parity, `first` and `second`, given by x = parity ^ first and a ^ b = first ^ second: returns the
//! carry and makes parity the low bit of the sum.
inline v_uint32 fullAdder(v_uint32& parity, const v_uint32& x, const v_uint32& a, const v_uint32& b)
{
    const v_uint32 before = parity;
#if CV_AVX512_SKX && IIB_NATIVE_VECTORS
    // The next parity is before ^ a ^ b; it stands for y in the table of the carry.
    parity = v_uint32(_mm512_ternarylogic_epi32(before.val, a.val, b.val, 0x96));
    return v_uint32(_mm512_ternarylogic_epi32(before.val, x.val, parity.val, 0x74));
#else
    const v_uint32 y = a ^ b;
    parity = before ^ y;
    return before ^ (x & ~y);
#endif
}

// lookUp16 picks bytes out of tables of 16, a table for each 16 bytes of the vector; an index is 0 to 15.
#if CV_AVX512_SKX && IIB_NATIVE_VECTORS
#define IIB_LOOKS_UP_16 1
inline v_uint8 lookUp16(const v_uint8& table, const v_uint8& index)
{
    return v_uint8(_mm512_shuffle_epi8(table.val, index.val));
}
#elif CV_AVX2 && IIB_NATIVE_VECTORS
#define IIB_LOOKS_UP_16 1
inline v_uint8 lookUp16(const v_uint8& table, const v_uint8& index)
{
    return v_uint8(_mm256_shuffle_epi8(table.val, index.val));
}
#elif CV_SSSE3 && IIB_NATIVE_VECTORS
#define IIB_LOOKS_UP_16 1
inline v_uint8 lookUp16(const v_uint8& table, const v_uint8& index)
{
    return v_uint8(_mm_shuffle_epi8(table.val, index.val));
}
#elif CV_NEON && defined __aarch64__ && IIB_NATIVE_VECTORS
#define IIB_LOOKS_UP_16 1
inline v_uint8 lookUp16(const v_uint8& table, const v_uint8& index)
{
    return v_uint8(vqtbl1q_u8(table.val, index.val));
}
#else
#define IIB_LOOKS_UP_16 0
#endif

// Moves the chosen lanes to the front of a vector.
#if CV_AVX512_SKX && IIB_NATIVE_VECTORS
#define IIB_COMPRESSES_LANES 1
inline v_int32 compressLanes(const v_int32& values, int lanes)
{
    return v_int32(_mm512_maskz_compress_epi32((__mmask16)lanes, values.val));
}
#else
#define IIB_COMPRESSES_LANES 0
#endif

CV_CPU_OPTIMIZATION_HAL_NAMESPACE_END

}  // namespace cv

#endif
