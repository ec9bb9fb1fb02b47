// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#include "precomp.hpp"
#include "common/image_input.hpp"

#include "kernels.simd.hpp"
#include "kernels.simd_declarations.hpp"

namespace cv {
namespace iib {

static void rowsOf(const Mat& image, Mat& grey, const Range& rows)
{
    CV_CPU_DISPATCH(greyRows, (image, grey, rows), CV_CPU_DISPATCH_MODES_ALL);
}

Mat greyOf(const Mat& image)
{
    Mat grey(image.size(), image.depth());
    parallel_for_(
            Range(0, image.rows), [&](const Range& rows) { rowsOf(image, grey, rows); },
            (double)image.total() / (1 << 16));
    return grey;
}

const BoxKernels& boxKernels() { CV_CPU_DISPATCH(boxKernels, (), CV_CPU_DISPATCH_MODES_ALL); }
const DescriptorKernels& descriptorKernels()
{
    CV_CPU_DISPATCH(descriptorKernels, (), CV_CPU_DISPATCH_MODES_ALL);
}
const DetectorKernels& detectorKernels() { CV_CPU_DISPATCH(detectorKernels, (), CV_CPU_DISPATCH_MODES_ALL); }
const HammingKernels& hammingKernels() { CV_CPU_DISPATCH(hammingKernels, (), CV_CPU_DISPATCH_MODES_ALL); }
const NormalizationKernels& normalizationKernels()
{
    CV_CPU_DISPATCH(normalizationKernels, (), CV_CPU_DISPATCH_MODES_ALL);
}
const RefinementKernels& refinementKernels()
{
    CV_CPU_DISPATCH(refinementKernels, (), CV_CPU_DISPATCH_MODES_ALL);
}

}  // namespace iib
}  // namespace cv
