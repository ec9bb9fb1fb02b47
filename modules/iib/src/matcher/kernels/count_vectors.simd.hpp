// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

// Vectors of one value for each code of a CodeBlock, which all kernels of the matcher share.

#pragma once

#include "../../common/vectors.simd.hpp"
#include "code_layout.hpp"

namespace cv {
namespace iib {
CV_CPU_OPTIMIZATION_NAMESPACE_BEGIN
namespace {

/* Each primitive is chosen by instruction set, never by the width of vectors, which different architectures share;
 where there is no portable form, a macro says whether it exists. */

typedef v_uint32 Words;
typedef v_int32 Counts;
const int CODES_PER_BLOCK = CodeLayout::CODES_PER_BLOCK, WIDTH = VTraits<Words>::max_nlanes,
          VECTORS = CODES_PER_BLOCK / WIDTH, ALL_LANES = (1 << CODES_PER_BLOCK) - 1;

//! 0, 1, 2, ... over the lanes of a vector.
inline Counts laneNumbers()
{
    static const int NUMBERS[CODES_PER_BLOCK] = {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15};
    return vx_load(NUMBERS);
}

//! The lanes with a negative value.
CV_ALWAYS_INLINE int negativeLanes(const Counts* values)
{
    int lanes = 0;
    for (int v = 0; v < VECTORS; v++)
        lanes |= v_signmask(values[v]) << v * WIDTH;
    return lanes;
}

}  // namespace
CV_CPU_OPTIMIZATION_NAMESPACE_END
}  // namespace iib
}  // namespace cv
