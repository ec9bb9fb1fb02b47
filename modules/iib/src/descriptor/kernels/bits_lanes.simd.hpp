// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

// Vectors whose comparisons are bits. Included by bits.simd.hpp.

#include "../../common/simd.hpp"
#include "../selection.hpp"

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

#define IIB_COMPARISON(op)                                                                                   \
    template <typename V> inline unsigned operator op(const Lanes<V>& a, const Lanes<V>& b)                  \
    {                                                                                                        \
        return (unsigned)v_signmask(a.v op b.v);                                                             \
    }
IIB_COMPARISON(>)
IIB_COMPARISON(>=)
IIB_COMPARISON(==)
#undef IIB_COMPARISON

#if CV_SIMD_WIDTH == 64
// Universal intrinsics turn the mask of a comparison into a vector and that into a mask again.
#define IIB_MASK_COMPARISON(op, function)                                                                    \
    inline unsigned operator op(const Lanes<v_int32>& a, const Lanes<v_int32>& b)                            \
    {                                                                                                        \
        return function(a.v.val, b.v.val);                                                                   \
    }
IIB_MASK_COMPARISON(>, _mm512_cmpgt_epi32_mask)
IIB_MASK_COMPARISON(>=, _mm512_cmpge_epi32_mask)
IIB_MASK_COMPARISON(==, _mm512_cmpeq_epi32_mask)
#undef IIB_MASK_COMPARISON
#endif

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
