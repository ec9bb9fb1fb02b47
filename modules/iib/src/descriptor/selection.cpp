// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#include "selection.hpp"

namespace cv {
namespace iib {

ChosenBits chosenBits(const Parameters& p, int level, int group, int index)
{
    const QuadPhase phase(1 << level, index);
    const int planes = bitsPerQuad(p.mapping), planeBits = 8 * phase.planeBytes();
    std::vector<uint64> masks((phase.rows * planes * planeBits + 63) / 64, 0);
    for (int i = 0; i < p.selection.rows; i++)
    {
        const int* quad = p.selection[i];
        const int channel = quad[1], row = quad[2], col = quad[3];
        if (quad[0] != level || channel / GROUP_CHANNELS != group || row % 2 != phase.dy ||
                col % 2 != phase.dx)
            continue;
        for (int plane = 0; plane < planes; plane++)
        {
            const int bit = (row / 2 * planes + plane) * planeBits + col / 2 * GROUP_CHANNELS +
                            channel % GROUP_CHANNELS;
            masks[bit / 64] |= (uint64)(quad[4] >> plane & 1) << bit % 64;
        }
    }
    return ChosenBits(masks);
}

}  // namespace iib
}  // namespace cv
