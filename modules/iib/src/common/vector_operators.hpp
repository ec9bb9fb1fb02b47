// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#ifndef OPENCV_IIB_COMMON_VECTOR_OPERATORS_HPP
#define OPENCV_IIB_COMMON_VECTOR_OPERATORS_HPP

#include "opencv2/core/version.hpp"

// Vectors of unknown length (RVV) cannot be members or elements of arrays, and only x86 has its own primitives
// for wide vectors: elsewhere a vector has 128 bits.
#if defined __riscv_vector
#define CV_FORCE_SIMD128_CPP
#elif defined __loongarch_asx
#define CV__SIMD_FORCE_WIDTH 128
#endif
#include "opencv2/core/hal/intrin.hpp"

/* OpenCV's universal intrinsics as all versions from 4.6 on have them: vectors with operators, and VTraits, whose
 max_nlanes replaces ::nlanes. Operators went from OpenCV with 4.11 (for NEON earlier), in favour of functions; where
 there are both, OpenCV's own operator is the better match. */
namespace cv {

CV_CPU_OPTIMIZATION_HAL_NAMESPACE_BEGIN

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

CV_CPU_OPTIMIZATION_HAL_NAMESPACE_END

}  // namespace cv

#endif
