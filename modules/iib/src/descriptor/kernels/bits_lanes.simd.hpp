// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#ifndef OPENCV_IIB_DESCRIPTOR_KERNELS_BITS_LANES_SIMD_HPP
#define OPENCV_IIB_DESCRIPTOR_KERNELS_BITS_LANES_SIMD_HPP

// Vectors whose comparisons are bits.

#include "../../common/simd.hpp"
#include "quads.hpp"

namespace cv {
namespace iib {

CV_CPU_OPTIMIZATION_NAMESPACE_BEGIN

namespace {

// Quads and channels that are mapped at a time, whatever the width of a vector, and their comparisons.
enum
{
    CHUNK = QuadPhase::CHUNK,
    LANES = VTraits<v_int32>::max_nlanes,
    CHUNK_VECTORS = CHUNK / LANES
};

//! A vector whose comparisons are bits, a bit a lane.
template <typename V> struct Lanes
{
    V v;

    Lanes() {}
    Lanes(const V& vector) : v(vector) {}
};

template <typename V> inline Lanes<V> operator+(const Lanes<V>& a, const Lanes<V>& b) { return a.v + b.v; }
template <typename V> inline Lanes<V> operator-(const Lanes<V>& a, const Lanes<V>& b) { return a.v - b.v; }
template <typename V> inline Lanes<V> operator<<(const Lanes<V>& a, int bits) { return a.v << bits; }
template <typename V> inline Lanes<V> operator>>(const Lanes<V>& a, int bits) { return a.v >> bits; }
template <typename V> inline Lanes<V> v_min(const Lanes<V>& a, const Lanes<V>& b)
{
    return cv::v_min(a.v, b.v);
}
template <typename V> inline Lanes<V> v_max(const Lanes<V>& a, const Lanes<V>& b)
{
    return cv::v_max(a.v, b.v);
}

inline unsigned operator>(const Lanes<v_int32>& a, const Lanes<v_int32>& b) { return greaterMask(a.v, b.v); }
inline unsigned operator>=(const Lanes<v_int32>& a, const Lanes<v_int32>& b)
{
    return greaterEqualMask(a.v, b.v);
}
inline unsigned operator==(const Lanes<v_int32>& a, const Lanes<v_int32>& b) { return equalMask(a.v, b.v); }

//! Collects comparisons, from a lane on.
struct Put
{
    unsigned* planes;
    int lane;

    void operator()(int plane, unsigned bits) const { planes[plane] |= bits << lane; }
};

}  // namespace

CV_CPU_OPTIMIZATION_NAMESPACE_END

}  // namespace iib
}  // namespace cv

#endif
