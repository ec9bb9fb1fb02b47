// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#pragma once

#include "opencv2/core/version.hpp"

#include <cstring>

// The vocabulary of all vector code: OpenCV's universal intrinsics, and what they lack, under names of its own. Raw intrinsics
// stand nowhere else. Each is chosen by instruction set, never by the width of vectors, which different architectures share;
// where there is no portable form, a macro says whether it exists.

// Vectors of unknown length (RVV) cannot be members or elements of arrays, and only x86 has its own primitives
// for wide vectors: elsewhere a vector has 128 bits.
#if defined __riscv_vector
#define CV_FORCE_SIMD128_CPP
#elif defined __loongarch_asx
#define CV__SIMD_FORCE_WIDTH 128
#endif
#include "opencv2/core/hal/intrin.hpp"

//! The name of the instruction set that a file is compiled for.
#ifdef CV_CPU_DISPATCH_MODE
#define IIB_INSTRUCTION_SET CVAUX_STR(CV_CPU_DISPATCH_MODE)
#else
#define IIB_INSTRUCTION_SET "baseline"
#endif

#ifdef CV_FORCE_SIMD128_CPP
#define IIB_NATIVE_VECTORS 0
#else
#define IIB_NATIVE_VECTORS 1
#endif
//! Whether lookUp() exists.
#if (CV_SSSE3 || (CV_NEON && defined __aarch64__)) && IIB_NATIVE_VECTORS
#define IIB_LOOKS_UP_BYTES 1
#else
#define IIB_LOOKS_UP_BYTES 0
#endif
//! Whether compressed() exists.
#if CV_AVX512_SKX && IIB_NATIVE_VECTORS
#define IIB_COMPRESSES_LANES 1
#else
#define IIB_COMPRESSES_LANES 0
#endif
//! Whether v_popcount(v_uint32) is one instruction; elsewhere counting bytes is cheaper. Whether SegmentSums exists: where one
//! instruction picks bytes out of a whole vector.
#if CV_AVX512_ICL && IIB_NATIVE_VECTORS
#define IIB_COUNTS_LANES 1
#define IIB_SUMS_SEGMENTS 1
#else
#define IIB_COUNTS_LANES 0
#define IIB_SUMS_SEGMENTS 0
#endif

namespace cv {
namespace iib {

CV_CPU_OPTIMIZATION_NAMESPACE_BEGIN

namespace {

/* What all versions from 4.6 on have: vectors with operators, and the number of their lanes. Operators went from OpenCV with
 4.11 (for NEON earlier), in favour of functions; where there are both, OpenCV's own operator is the better match. */
template <typename V> struct VTraits
{
#if CV_VERSION_MAJOR == 4 && CV_VERSION_MINOR < 7
    static constexpr int max_nlanes = V::nlanes;
#else
    static constexpr int max_nlanes = cv::VTraits<V>::max_nlanes;
#endif
};

#define IIB_VECTOR_OPERATOR(op, function)                                                                    \
    template <typename V> inline auto operator op(const V& a, const V& b)->decltype(function(a, b))          \
    {                                                                                                        \
        return function(a, b);                                                                               \
    }
#define IIB_VECTOR_ASSIGNMENT(op, function)                                                                  \
    template <typename V> inline auto operator op(V& a, const V& b)->decltype(a = function(a, b))            \
    {                                                                                                        \
        return a = function(a, b);                                                                           \
    }
#define IIB_VECTOR_SHIFT(op, function)                                                                       \
    template <typename V> inline auto operator op(const V& a, int bits)->decltype(function(a, bits))         \
    {                                                                                                        \
        return function(a, bits);                                                                            \
    }

IIB_VECTOR_OPERATOR(+, v_add)
IIB_VECTOR_OPERATOR(-, v_sub)
IIB_VECTOR_OPERATOR(*, v_mul)
IIB_VECTOR_OPERATOR(/, v_div)
IIB_VECTOR_OPERATOR(&, v_and)
IIB_VECTOR_OPERATOR(|, v_or)
IIB_VECTOR_OPERATOR(^, v_xor)
IIB_VECTOR_OPERATOR(<, v_lt)
IIB_VECTOR_OPERATOR(>, v_gt)
IIB_VECTOR_OPERATOR(<=, v_le)
IIB_VECTOR_OPERATOR(>=, v_ge)
IIB_VECTOR_OPERATOR(==, v_eq)
IIB_VECTOR_OPERATOR(!=, v_ne)
IIB_VECTOR_ASSIGNMENT(+=, v_add)
IIB_VECTOR_ASSIGNMENT(-=, v_sub)
IIB_VECTOR_ASSIGNMENT(&=, v_and)
IIB_VECTOR_ASSIGNMENT(|=, v_or)
IIB_VECTOR_ASSIGNMENT(^=, v_xor)
IIB_VECTOR_SHIFT(<<, v_shl)
IIB_VECTOR_SHIFT(>>, v_shr)

template <typename V> inline auto operator~(const V& a) -> decltype(v_not(a)) { return v_not(a); }

#undef IIB_VECTOR_OPERATOR
#undef IIB_VECTOR_ASSIGNMENT
#undef IIB_VECTOR_SHIFT

//! Lanes of a vector.
constexpr int SHORTS = VTraits<v_int16>::max_nlanes, INTS = VTraits<v_int32>::max_nlanes;

inline v_int16 absolute(const v_int16& v) { return v_reinterpret_as_s16(v_abs(v)); }
inline v_int32 absolute(const v_int32& v) { return v_reinterpret_as_s32(v_abs(v)); }

/* Quotients, roots and nearest integers as IEEE 754 says. On ARMv7 the vectors' first two are estimates, and v_round
 rounds halves up; scalars are exact there. */
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

/* Vectors of 256 bits at most, for values that come from many places. */
#if CV_AVX2
typedef v_int32x8 v_samples;
typedef v_float32x8 v_means;

inline v_samples v_load_samples(const int* p) { return v256_load(p); }
inline v_samples v_load_samples(const short* p) { return v256_load_expand(p); }
inline v_samples v_load_words(const uchar* p) { return v_reinterpret_as_s32(v256_load(p)); }
inline v_samples v_setall_samples(int v) { return v256_setall_s32(v); }
inline v_means v_load_means(const float* p) { return v256_load(p); }
inline v_means v_setall_means(float v) { return v256_setall_f32(v); }
#else
typedef v_int32x4 v_samples;
typedef v_float32x4 v_means;

inline v_samples v_load_samples(const int* p) { return v_load(p); }
inline v_samples v_load_samples(const short* p) { return v_load_expand(p); }
inline v_samples v_load_words(const uchar* p) { return v_reinterpret_as_s32(v_load(p)); }
inline v_samples v_setall_samples(int v) { return v_setall_s32(v); }
inline v_means v_load_means(const float* p) { return v_load(p); }
inline v_means v_setall_means(float v) { return v_setall_f32(v); }
#endif

//! Words of four bytes, each SCALE times an offset from `base`, wherever that is.
#if CV_AVX2
template <int SCALE> inline v_int32x8 gatherWords(const void* base, const v_int32x8& offsets)
{
    return v_int32x8(_mm256_i32gather_epi32(static_cast<const int*>(base), offsets.val, SCALE));
}
#else
template <int SCALE> inline v_int32x4 gatherWords(const void* base, const v_int32x4& offsets)
{
    int at[4], words[4];
    v_store(at, offsets);
    for (int i = 0; i < 4; i++)
        std::memcpy(words + i, static_cast<const uchar*>(base) + (ptrdiff_t)SCALE * at[i], sizeof(int));
    return v_int32x4(words[0], words[1], words[2], words[3]);
}
#endif
#if CV_AVX512_SKX
template <int SCALE> inline v_int32x16 gatherWords(const void* base, const v_int32x16& offsets)
{
    return v_int32x16(_mm512_i32gather_epi32(offsets.val, base, SCALE));
}
#endif

//! A bit for each lane, all of whose bits are equal.
template <typename V> inline unsigned laneBits(const V& lanes) { return (unsigned)v_signmask(lanes); }
inline unsigned laneBits(bool lane) { return lane; }  // where no vectors of doubles are (ARMv7, WebAssembly)
#if CV_AVX512_SKX  // of a mask of eight lanes that it keeps in memory, GCC 12 may store one byte and read four
inline unsigned laneBits(const v_float64& lanes)
{
    return (unsigned)_mm_movemask_epi8(_mm512_cvtepi64_epi8(_mm512_castpd_si512(lanes.val)));
}
#endif

//! A bit for each lane where the comparison holds.
template <typename V> inline unsigned greaterMask(const V& a, const V& b) { return laneBits(a > b); }
template <typename V> inline unsigned greaterEqualMask(const V& a, const V& b) { return laneBits(a >= b); }
template <typename V> inline unsigned equalMask(const V& a, const V& b) { return laneBits(a == b); }
#if CV_AVX512_SKX  // the above turns its masks into vectors and back
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
inline unsigned greaterMask(const v_int16& a, const v_int16& b)
{
    return _mm512_cmpgt_epi16_mask(a.val, b.val);
}
#endif

/* Doubles, or one of them where there are no such vectors (ARMv7, WebAssembly). */
#if CV_SIMD_64F
typedef v_float64 v_doubles;

inline v_doubles loadDoubles(const double* p) { return vx_load(p); }
inline v_doubles repeatedDouble(double v) { return vx_setall_f64(v); }
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
#endif

/* Bits and bytes. */

//! Number of set bits.
inline int countBits(uint64 word)
{
#if CV_POPCNT && (defined __x86_64__ || defined _M_X64)
    return (int)_mm_popcnt_u64(word);
#else
    word -= word >> 1 & CV_BIG_UINT(0x5555555555555555);
    word = (word & CV_BIG_UINT(0x3333333333333333)) + (word >> 2 & CV_BIG_UINT(0x3333333333333333));
    return (int)(((word + (word >> 4)) & CV_BIG_UINT(0x0f0f0f0f0f0f0f0f)) * CV_BIG_UINT(0x0101010101010101) >>
                 56);
#endif
}

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

#if IIB_LOOKS_UP_BYTES
//! Picks bytes out of tables of 16, a table for each 16 bytes of the vector; an index is 0 to 15.
inline v_uint8 lookUp(const v_uint8& table, const v_uint8& index)
{
#if CV_AVX512_SKX
    return v_uint8(_mm512_shuffle_epi8(table.val, index.val));
#elif CV_AVX2
    return v_uint8(_mm256_shuffle_epi8(table.val, index.val));
#elif CV_SSSE3
    return v_uint8(_mm_shuffle_epi8(table.val, index.val));
#else
    return v_uint8(vqtbl1q_u8(table.val, index.val));
#endif
}
#if CV_AVX2
inline v_uint8x16 lookUp(const v_uint8x16& table, const v_uint8x16& index)
{
    return v_uint8x16(_mm_shuffle_epi8(table.val, index.val));
}
#endif
#endif

#if IIB_COMPRESSES_LANES
//! The values of some lanes, side by side.
inline v_int32 compressed(const v_int32& values, int lanes)
{
    return v_int32(_mm512_maskz_compress_epi32((__mmask16)lanes, values.val));
}
#endif

//! GCC 12 leaves the upper halves of registers in use; code without AVX that follows, also a user's, runs at half the speed.
inline void freeUpperHalves()
{
#if CV_AVX512_SKX
    _mm256_zeroupper();
#endif
}

/* Comparison, and moves between lanes. */

//! `whole` - v where a < b, else v.
template <typename V> inline V subtractWhereLess(const V& a, const V& b, const V& whole, const V& v)
{
    return v_select(a < b, whole - v, v);
}

#if CV_AVX512_SKX  // the above turns its masks into vectors and back
inline v_int16 subtractWhereLess(const v_int16& a, const v_int16& b, const v_int16& whole, const v_int16& v)
{
    return v_int16(_mm512_mask_sub_epi16(v.val, _mm512_cmplt_epi16_mask(a.val, b.val), whole.val, v.val));
}
#endif

/* Interleaves four planes; out[0] gets the first pixels. Zipping is cheap only within 128 bits, so that wider vectors
 are first permuted. */
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

//! The values that lie eight behind those of a vector. @param next the vector behind it.
inline v_int16 eightBehind(const v_int16& values, const v_int16& next)
{
#if CV_AVX512_SKX
    return v_int16(_mm512_alignr_epi64(next.val, values.val, 2));
#elif CV_AVX2
    return v_int16(_mm256_permute2x128_si256(values.val, next.val, 0x21));
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
#endif

}  // namespace

CV_CPU_OPTIMIZATION_NAMESPACE_END

}  // namespace iib
}  // namespace cv
