// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#pragma once

#include "../parameters.hpp"
#include "kernels/boxes.hpp"

namespace cv {
namespace iib {

//! Which boxes and comparisons a descriptor of MAPPING_BOXES needs.
struct BoxPlan
{
    //! One that has any bit.
    struct Level
    {
        BoxGridShape shape;
        double side;                  //!< of a box, in sides of the region
        std::vector<double> centres;  //!< along either axis, in sides of the region from its centre
        int offset;                   //!< of the first bit in the descriptor
        ChosenBits chosen;
    };

    std::vector<Level> levels;
    double edges
            [2][MAX_BOX_PLACES];  //!< where boxes begin and end, in the unit of centres; unused entries are 0

    const BoxKernels& kernels;

    BoxPlan() : edges(), kernels(boxKernels()) {}
};

BoxPlan makeBoxPlan(const Parameters& checked);

}  // namespace iib
}  // namespace cv
