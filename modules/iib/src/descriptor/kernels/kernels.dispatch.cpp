// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#include "../../precomp.hpp"

#include "kernels.simd.hpp"
#include "descriptor/kernels/kernels.simd_declarations.hpp"

namespace cv {
namespace iib {

const DescriptorKernels& descriptorKernels()
{
    CV_CPU_DISPATCH(descriptorKernels, (), CV_CPU_DISPATCH_MODES_ALL);
}

ChosenBits::ChosenBits(const std::vector<uint64>& masks)
{
    for (size_t bit = 0; bit < 64 * masks.size(); bit++)
    {
        if (!(masks[bit / 64] >> bit % 64 & 1))
            continue;
        const size_t byte = bit / 8;
        if (none() || chosen.back().count == Group::SIZE || byte - chosen.back().byte >= Group::SIZE)
        {
            Group next = {byte, 0, {}, {}};
            std::fill_n(next.places, (int)Group::SIZE, (uchar)128);
            std::fill_n(next.masks, (int)Group::SIZE, (uchar)1);
            chosen.push_back(next);
        }
        Group& group = chosen.back();
        group.places[group.count] = (uchar)(byte - group.byte);
        group.masks[group.count++] = (uchar)(1 << bit % 8);
    }
}

}  // namespace iib
}  // namespace cv
