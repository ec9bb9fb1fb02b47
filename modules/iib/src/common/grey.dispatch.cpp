// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#include "image_input.hpp"

#include "grey.simd.hpp"
#include "common/grey.simd_declarations.hpp"

namespace cv { namespace iib {

Mat greyOf(const Mat& image)
{
    Mat grey(image.size(), image.depth());
    parallel_for_(
            Range(0, image.rows),
            [&](const Range& rows) {
                CV_CPU_DISPATCH(greyRows, (image, grey, rows), CV_CPU_DISPATCH_MODES_ALL);
            },
            (double)image.total() / (1 << 16));
    return grey;
}

}}  // namespace cv::iib
