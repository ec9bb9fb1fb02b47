// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#pragma once

#include "../precomp.hpp"

#include "opencv2/core/hal/intrin.hpp"

namespace cv { namespace iib {

// What kernels/mappings.hpp compares: numbers of one channel,
inline int64 least(int64 a, int64 b) { return std::min(a, b); }
inline int64 greatest(int64 a, int64 b) { return std::max(a, b); }
inline int64 fourTimes(int64 v) { return 4 * v; }
inline int64 quarter(int64 v) { return v / 4; }

#if CV_SIMD128
//! or of all four, where 32 bits are enough.
struct Lanes
{
    v_int32x4 v;
    Lanes(const v_int32x4& vector) : v(vector) {}
};

inline Lanes operator+(const Lanes& a, const Lanes& b) { return v_add(a.v, b.v); }
inline Lanes operator-(const Lanes& a, const Lanes& b) { return v_sub(a.v, b.v); }
inline Lanes operator>(const Lanes& a, const Lanes& b) { return v_gt(a.v, b.v); }
inline Lanes operator>=(const Lanes& a, const Lanes& b) { return v_ge(a.v, b.v); }
inline Lanes operator==(const Lanes& a, const Lanes& b) { return v_eq(a.v, b.v); }
inline Lanes operator&(const Lanes& a, const Lanes& b) { return v_and(a.v, b.v); }
inline Lanes operator|(const Lanes& a, const Lanes& b) { return v_or(a.v, b.v); }
inline Lanes operator^(const Lanes& a, const Lanes& b) { return v_xor(a.v, b.v); }
inline Lanes least(const Lanes& a, const Lanes& b) { return v_min(a.v, b.v); }
inline Lanes greatest(const Lanes& a, const Lanes& b) { return v_max(a.v, b.v); }
inline Lanes fourTimes(const Lanes& a) { return v_shl<2>(a.v); }
inline Lanes quarter(const Lanes& a) { return v_shr<2>(a.v); }
#endif

}}  // namespace cv::iib

// Behind what its templates call.
#include "kernels/mappings.hpp"
