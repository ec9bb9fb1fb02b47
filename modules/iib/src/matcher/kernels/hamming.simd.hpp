// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#include "hamming.hpp"

namespace cv { namespace iib {
CV_CPU_OPTIMIZATION_NAMESPACE_BEGIN
const HammingKernels& hammingKernels();
CV_CPU_OPTIMIZATION_NAMESPACE_END
}}  // namespace cv::iib

#ifndef CV_CPU_OPTIMIZATION_DECLARATIONS_ONLY

#include "scan_pruned.simd.hpp"

namespace cv { namespace iib {
CV_CPU_OPTIMIZATION_NAMESPACE_BEGIN
namespace {

//! Processes Q queries at a time, then the remainder in smaller groups.
template <int Q, class S> void scanAll(S&& scanner, int queryCount)
{
    int q = 0;
    for (; q + Q <= queryCount; q += Q)
        scanner.template row<Q>(q);
    for (; q + LISTED_QUERIES <= queryCount; q += LISTED_QUERIES)
        scanner.template row<LISTED_QUERIES>(q);
    for (; q < queryCount; q++)
        scanner.template row<1>(q);
}

template <int COUNT> void nearestOfEach(const NearestScan& scan)
{
    NearestScanner<COUNT> scanner(scan);
    scanAll<QUERIES>(scanner, scan.pairs.queries.rows);
    scanner.keepOfTrains();
}

void nearest(const NearestScan& scan) { scan.count == 1 ? nearestOfEach<1>(scan) : nearestOfEach<2>(scan); }

void pruned(const PrunedScan& scan) { scanAll<LISTED_QUERIES>(PrunedScanner(scan), scan.pairs.queries.rows); }

}  // namespace

const HammingKernels& hammingKernels()
{
    static const HammingKernels kernels = {PACKING, nearest, pruned, IIB_INSTRUCTION_SET};
    return kernels;
}

CV_CPU_OPTIMIZATION_NAMESPACE_END
}}  // namespace cv::iib

#endif
