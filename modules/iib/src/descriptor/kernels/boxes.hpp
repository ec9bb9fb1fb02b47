// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#ifndef OPENCV_IIB_DESCRIPTOR_KERNELS_BOXES_HPP
#define OPENCV_IIB_DESCRIPTOR_KERNELS_BOXES_HPP

#include "quads.hpp"

namespace cv {
namespace iib {

/* MAPPING_BOXES: means over boxes on overlapping grids, from an integral image over cells of BOX_CELL x BOX_CELL pixels
 with BOX_LANES values side by side, so that one vector (or two) holds a corner of a box in all channels. */

//! What is summed; the last two only serve rotation.
enum BoxLane
{
    LANE_ABSOLUTE_X,
    LANE_ABSOLUTE_Y,
    LANE_GRADIENT_X,
    LANE_GRADIENT_Y,
    LANE_INTENSITY,
    LANE_ABSOLUTE_SUM,         //!< |gx + gy|
    LANE_ABSOLUTE_DIFFERENCE,  //!< |gx - gy|
    BOX_LANES = 8
};

enum
{
    BOX_CELL = 2,    //!< pixels along the side of a cell
    BOX_PLANES = 3,  //!< gx, gy and intensity of a row of pixels
    BOX_LEVELS = 5,
    MAX_BOXES = 256
};

/** The comparisons of a level, of which any bit is chosen, as bytes with a bit for each lane: three for each quad, as
 MAPPING_HAAR; then one for each box, four bits of |gx| > |gy|, gx > 0, gy > 0 and four of gx > gy, gy > -gx. */
struct BoxComparisons
{
    struct Quad
    {
        ushort boxes[4];  //!< top left, top right, bottom left, bottom right
    };

    int offset;  //!< of the first bit in the descriptor
    std::vector<Quad> quads;
    std::vector<ushort> boxes;
    ChosenBits chosen;
};

//! Where the boxes of a keypoint lie in an integral image, in cells.
struct BoxPlaces
{
    int corner[MAX_BOXES];    //!< top left, from the image's first cell
    int right[MAX_BOXES];     //!< from there to the top right corner
    int below[MAX_BOXES];     //!< and to the bottom left one
    float weight[MAX_BOXES];  //!< what a box's sum is multiplied by: 1 if all of its cells count
};

//! A grid's boxes for one keypoint.
struct BoxFrame
{
    double x, y;          //!< the region's centre, in cells
    double cosine, sine;  //!< times the region's side in cells
    double side;          //!< of a box, whole cells
    Rect bounds;          //!< the cells that count
    Point origin;         //!< the first cell of the integral image, and
    int step;             //!< how many it has in a row
};

template <typename T, typename Sum> struct SumCellRowFunc
{
    /** A row of the integral image from two rows of pixels: out = above + sums along the row; both begin left of the
     first cell. @param rows ROW_PADDING values longer than the cells. */
    typedef void (*Type)(const T* const rows[BOX_CELL][BOX_PLANES], int cells, const Sum* above, Sum* out);
};

template <typename Sum> struct BoxMeansFunc
{
    //! BOX_LANES values a box, comparable within a grid.
    typedef void (*Type)(const Sum* integral, const BoxPlaces& places, int count, float* means);
};

struct BoxKernels
{
    SumCellRowFunc<short, unsigned>::Type sumShortRow;
    SumCellRowFunc<short, int64>::Type sumLongRow;
    SumCellRowFunc<int, int64>::Type sumIntRow;
    BoxMeansFunc<unsigned>::Type means;
    BoxMeansFunc<int64>::Type longMeans;

    //! Boxes first to end, whose centres are at (x, y) sides of the region from its own.
    void (*places)(
            const BoxFrame& frame, const double* x, const double* y, int first, int end, BoxPlaces& places);

    //! means = sum over j of matrix[j] * means[j] for each box, without the last lane.
    void (*rotate)(const float matrix[BOX_LANES][BOX_LANES], int count, float* means);

    void (*bits)(const float* means, const BoxComparisons& level, uchar* descriptor);
};

}  // namespace iib
}  // namespace cv

#endif
