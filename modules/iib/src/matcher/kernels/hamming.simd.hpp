// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#include "hamming.hpp"

#ifndef CV_CPU_OPTIMIZATION_DECLARATIONS_ONLY
#include "count_vectors.simd.hpp"
#include "pair_rows.simd.hpp"
#if !CV_AVX512_ICL && (CV_SSSE3 || (CV_NEON && defined __aarch64__))
#include "tile_tables.simd.hpp"
#else
#include "tile_adders.simd.hpp"
#endif
#include "scanner.simd.hpp"
#include "scan_pruned.simd.hpp"
#endif

namespace cv {
namespace iib {
CV_CPU_OPTIMIZATION_NAMESPACE_BEGIN

void hammingScan(const HammingScan& scan);
CodePacking hammingPacking();
const char* hammingInstructionSet();

#ifndef CV_CPU_OPTIMIZATION_DECLARATIONS_ONLY

namespace {

template <class S> void scanAll(S&& scanner, int queryCount)
{
    int q = 0;
    for (; q + QUERIES <= queryCount; q += QUERIES)
        scanner.template row<QUERIES>(q);
    for (; q < queryCount; q++)
        scanner.template row<1>(q);
}

}  // namespace

void hammingScan(const HammingScan& scan)
{
    if (scan.stopCount > 0)
        scanAll(PrunedScanner(scan), scan.queryCount);
    else
        scanAll(FullScanner(scan), scan.queryCount);
}

CodePacking hammingPacking() { return PACKING; }

const char* hammingInstructionSet()
{
#ifdef CV_CPU_DISPATCH_MODE
    return CVAUX_STR(CV_CPU_DISPATCH_MODE);
#else
    return "baseline";
#endif
}

#endif

CV_CPU_OPTIMIZATION_NAMESPACE_END
}  // namespace iib
}  // namespace cv
