// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#pragma once

// Bits of cells whose sums or products 32-bit integers are too small for: vectors of doubles in place of v_int32.

#include "bits_planes.simd.hpp"

namespace cv {

CV_CPU_OPTIMIZATION_HAL_NAMESPACE_BEGIN

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
//! As if a comparison gave a lane of all ones or zeros.
inline int v_signmask(bool comparison) { return comparison; }
#endif

CV_CPU_OPTIMIZATION_HAL_NAMESPACE_END

namespace iib {

CV_CPU_OPTIMIZATION_NAMESPACE_BEGIN

namespace {

inline v_doubles loadCells(const double* p) { return loadDoubles(p); }
inline v_doubles repeated(int v, const v_doubles&) { return repeatedDouble(v); }

inline void storeAlternately(double* even, double* odd, int lane, const v_doubles& v)
{
#if CV_AVX512_SKX
    v_store_low(even + lane / 2, v);
    v_store_high(odd + lane / 2, v);
#else
    v_store((lane % 8 < 4 ? even : odd) + lane / 8 * 4 + lane % 4, v);
#endif
}

//! Weights of a chunk of quads along a row.
template <typename V> struct ColumnWeights;

template <> struct ColumnWeights<v_doubles>
{
    v_doubles left[Chunk<v_doubles>::VECTORS], right[Chunk<v_doubles>::VECTORS];

    ColumnWeights(const Axis& axis, int x)
    {
        double lefts[CHUNK], rights[CHUNK];
        for (int lane = 0; lane < CHUNK; lane++)
        {
            const Weights weights(axis, x + lane / GROUP_CHANNELS * 2);
            lefts[lane] = weights.first;
            rights[lane] = weights.second;
        }
        for (int i = 0; i < Chunk<v_doubles>::VECTORS; i++)
        {
            left[i] = loadDoubles(lefts + i * Chunk<v_doubles>::LANES);
            right[i] = loadDoubles(rights + i * Chunk<v_doubles>::LANES);
        }
    }
};

}  // namespace

CV_CPU_OPTIMIZATION_NAMESPACE_END

}  // namespace iib
}  // namespace cv
