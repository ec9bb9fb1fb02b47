// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#pragma once

#include "opencv2/core/version.hpp"

// OpenCV's universal intrinsics, and what all vector code shares.

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

/* OpenCV's universal intrinsics as all versions from 4.6 on have them: vectors with operators, and VTraits, whose
 max_nlanes replaces ::nlanes. Operators went from OpenCV with 4.11 (for NEON earlier), in favour of functions; where
 there are both, OpenCV's own operator is the better match. */
namespace cv {

CV_CPU_OPTIMIZATION_HAL_NAMESPACE_BEGIN

#ifdef CV_FORCE_SIMD128_CPP
#define IIB_NATIVE_VECTORS 0
#else
#define IIB_NATIVE_VECTORS 1
#endif

#if CV_VERSION_MAJOR == 4 && CV_VERSION_MINOR < 7
template <typename V> struct VTraits
{
    enum
    {
        max_nlanes = V::nlanes
    };
};
#endif

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
inline v_samples v_setall_samples(int v) { return v256_setall_s32(v); }
inline v_means v_load_means(const float* p) { return v256_load(p); }
inline v_means v_setall_means(float v) { return v256_setall_f32(v); }
#else
typedef v_int32x4 v_samples;
typedef v_float32x4 v_means;

inline v_samples v_load_samples(const int* p) { return v_load(p); }
inline v_samples v_load_samples(const short* p) { return v_load_expand(p); }
inline v_samples v_setall_samples(int v) { return v_setall_s32(v); }
inline v_means v_load_means(const float* p) { return v_load(p); }
inline v_means v_setall_means(float v) { return v_setall_f32(v); }
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

CV_CPU_OPTIMIZATION_HAL_NAMESPACE_END

}  // namespace cv
