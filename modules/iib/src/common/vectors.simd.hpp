// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#pragma once

#include "opencv2/core/version.hpp"

#include <cstring>

// The vocabulary of all vector code: OpenCV's universal intrinsics, and additions with raw intrinsics. Additions are chosen by
// instruction set, never by the width of vectors. If an addition has no portable form, a macro says whether it exists.

// Vectors of unknown length (RVV) cannot be members or elements of arrays. Except on x86, vectors have 128 bits.
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
#define IIB_COMPRESSES_LANES (CV_AVX512_SKX && IIB_NATIVE_VECTORS)
//! Whether v_popcount(v_uint32) is one instruction; if not, counting bytes is cheaper. And whether SegmentSums exists, which
//! needs an instruction that picks bytes out of a whole vector.
#define IIB_COUNTS_LANES (CV_AVX512_ICL && IIB_NATIVE_VECTORS)
#define IIB_SUMS_SEGMENTS IIB_COUNTS_LANES

namespace cv { namespace iib {
CV_CPU_OPTIMIZATION_NAMESPACE_BEGIN
namespace {

/* Operators and lane numbers for all versions from 4.6 on. OpenCV 4.11 (for NEON earlier) replaced operators by functions. If
 both exist, overload resolution prefers OpenCV's operator. */
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

/* Quotients, roots and nearest integers by IEEE 754. On ARMv7, vector quotients and roots are estimates, and v_round rounds
 halves up, so scalars are used. */
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
inline unsigned laneBits(bool lane) { return lane; }  // without vectors of doubles (ARMv7, WebAssembly)
#if CV_AVX512_SKX  // v_signmask: GCC 12 may store one byte of a mask of eight lanes and read four
inline unsigned laneBits(const v_float64& lanes)
{
    return (unsigned)_mm_movemask_epi8(_mm512_cvtepi64_epi8(_mm512_castpd_si512(lanes.val)));
}
#endif

//! A bit for each lane where the comparison holds.
template <typename V> inline unsigned greaterMask(const V& a, const V& b) { return laneBits(a > b); }
template <typename V> inline unsigned greaterEqualMask(const V& a, const V& b) { return laneBits(a >= b); }
template <typename V> inline unsigned equalMask(const V& a, const V& b) { return laneBits(a == b); }
#if CV_AVX512_SKX  // the functions above convert masks to vectors and back
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

/* Vectors of doubles, or scalars (ARMv7, WebAssembly). */
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

//! A full adder of parity, `first` and `second`, which are given by x = parity ^ first and a ^ b = first ^ second. Returns the
//! carry; parity becomes the sum's low bit.
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
//! Looks bytes up in tables of 16, one for each 16 bytes of the vector; an index is 0 to 15.
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

//! GCC 12 leaves the upper halves of registers dirty, which halves the speed of SSE code that follows, also a user's.
inline void freeUpperHalves()
{
#if CV_AVX512_SKX
    _mm256_zeroupper();
#endif
}

}  // namespace
CV_CPU_OPTIMIZATION_NAMESPACE_END
}}  // namespace cv::iib
