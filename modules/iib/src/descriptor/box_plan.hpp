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
};

//! Level g is BOX_GRIDS[g - 1].
static const BoxGrid BOX_GRIDS[BOX_LEVELS] = {{3, 32, 24}, {5, 24, 28}, {7, 16, 30}, {9, 9, 32}, {7, 6, 12}};

//! The bits that a box has in a channel, as the mask of a selection; `channel` counts those in use.
int boxMask(const Parameters& parameters, int level, int channel, int row, int col);

//! The selection that is in force for MAPPING_BOXES: all bits, if none was given.
Mat_<int> boxSelection(const Parameters& parameters);

//! Which boxes and comparisons a descriptor of MAPPING_BOXES needs.
struct BoxPlan
{
    struct Level
    {
        int side;        //!< of a box, in 80ths of the region's
        int first, end;  //!< the boxes of the level
        BoxComparisons comparisons;
    };

    explicit BoxPlan(const Parameters& checked);

    std::vector<double> x, y;  //!< centres of boxes in sides of the region from its own, BoxGrid::centre()
    std::vector<Level> levels;

    int boxes() const { return (int)x.size(); }
};

}  // namespace iib
}  // namespace cv

#endif
