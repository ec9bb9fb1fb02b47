// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#ifndef OPENCV_IIB_DESCRIPTOR_BOX_PLAN_HPP
#define OPENCV_IIB_DESCRIPTOR_BOX_PLAN_HPP

#include "kernels/boxes.hpp"
#include "parameters.hpp"

namespace cv {
namespace iib {

//! n x n boxes, in 80ths of the region's side.
struct BoxGrid
{
    int n;
    int side;   //!< of a box
    int reach;  //!< of the outermost centres from the region's

    //! The centre of box i of a row or column, in sides of the region from its centre.
    double centre(int i) const { return reach * (2. * i / (n - 1) - 1) / 80; }

    //! Its left or upper edge (direction -1), or the opposite one (1); equal for boxes that meet.
    double edge(int i, int direction) const
    {
        return (2 * reach * i - (n - 1) * reach + direction * side * (n - 1) / 2.) / (80. * (n - 1));
    }
};

//! Level g is BOX_GRIDS[g - 1].
static const BoxGrid BOX_GRIDS[BOX_LEVELS] = {{3, 32, 24}, {5, 24, 28}, {7, 16, 30}, {9, 8, 32}, {7, 6, 12}};

//! The bits that a box has in a channel, as the mask of a selection; `channel` counts those in use.
int boxMask(const Parameters& parameters, int level, int channel, int row, int col);

//! The selection that is in force for MAPPING_BOXES: all bits, if none was given.
Mat_<int> boxSelection(const Parameters& parameters);

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

    explicit BoxPlan(const Parameters& checked);

    std::vector<Level> levels;
    double edges[2][MAX_BOX_PLACES];  //!< where boxes begin and end, as centres; 0 behind the last one
};

}  // namespace iib
}  // namespace cv

#endif
