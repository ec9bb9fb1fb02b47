// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

// The dispatched file of the module: it is compiled with all chapters below for each instruction set.

#include "descriptor/kernels/boxes.hpp"
#include "detector/kernels/kernels.hpp"
#include "matcher/kernels/hamming.hpp"
#include "normalization/kernels/kernels.hpp"
#include "refinement/kernels/kernels.hpp"

namespace cv {
namespace iib {

CV_CPU_OPTIMIZATION_NAMESPACE_BEGIN

void greyRows(const Mat& image, Mat& grey, const Range& rows);
const BoxKernels& boxKernels();
const DescriptorKernels& descriptorKernels();
const DetectorKernels& detectorKernels();
const HammingKernels& hammingKernels();
const NormalizationKernels& normalizationKernels();
const RefinementKernels& refinementKernels();

CV_CPU_OPTIMIZATION_NAMESPACE_END

}  // namespace iib
}  // namespace cv

#ifndef CV_CPU_OPTIMIZATION_DECLARATIONS_ONLY
#include "common/grey.simd.hpp"
#include "descriptor/kernels/kernels.simd.hpp"
#include "detector/kernels/kernels.simd.hpp"
#include "matcher/kernels/hamming.simd.hpp"
#include "normalization/kernels/kernels.simd.hpp"
#include "refinement/kernels/kernels.simd.hpp"
#endif
