// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#include "precomp.hpp"

#include "bits.simd.hpp"
#include "bits.simd_declarations.hpp"

namespace cv {
namespace iib {

LevelBitsFunc getLevelBitsFunc(int mapping)
{
    CV_CPU_DISPATCH(getLevelBitsFunc, (mapping), CV_CPU_DISPATCH_MODES_ALL);
}

SelectedBitsFunc getSelectedBitsFunc(int mapping)
{
    CV_CPU_DISPATCH(getSelectedBitsFunc, (mapping), CV_CPU_DISPATCH_MODES_ALL);
}

}  // namespace iib
}  // namespace cv
