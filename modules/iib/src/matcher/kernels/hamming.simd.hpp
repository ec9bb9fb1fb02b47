// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#include "hamming.hpp"

#ifndef CV_CPU_OPTIMIZATION_DECLARATIONS_ONLY
#include "scan_nearest.simd.hpp"
#include "scan_pruned.simd.hpp"
#endif

namespace cv {
namespace iib {
CV_CPU_OPTIMIZATION_NAMESPACE_BEGIN

const HammingKernels& hammingKernels();

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

void scanNearest(const NearestScan& scan)
{
    NearestScanner scanner(scan);
    scanAll(scanner, scan.pairs.queries.rows);
    scanner.keepOfTrains();
}

void scanPruned(const PrunedScan& scan) { scanAll(PrunedScanner(scan), scan.pairs.queries.rows); }

}  // namespace

const HammingKernels& hammingKernels()
{
    static const HammingKernels kernels = {PACKING, scanNearest, scanPruned, IIB_INSTRUCTION_SET};
    return kernels;
}

#endif

CV_CPU_OPTIMIZATION_NAMESPACE_END
}  // namespace iib
}  // namespace cv
