// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#include "boxes.hpp"

#include "cell_band.hpp"
#include "rotation.hpp"

namespace cv {
namespace iib {

namespace {

int floorHalf(int v) { return v >= 0 ? v / 2 : -((1 - v) / 2); }

//! The whole cells that hold some pixels.
Rect cellsOf(Rect pixels)
{
    const Point first(floorHalf(pixels.x), floorHalf(pixels.y));
    return Rect(
            first, Point(floorHalf(pixels.x + pixels.width + 1), floorHalf(pixels.y + pixels.height + 1)));
}

//! The pixels that count, for a region that may leave the image by a rounding.
Rect boundsOf(int border, Size image)
{
    const Rect all = border == IIB::BORDER_REFLECT ? reflectedImage(image) : Rect(Point(), image);
    const Rect cells = cellsOf(all);
    return Rect(cells.tl() * (int)BOX_CELL, cells.size() * (int)BOX_CELL);
}

/* The matrix that turns means, a row for each lane that is read. The mean of |gx cos a + gy sin a| has period 180 degrees;
 from its values at 0, 45, 90 and 135 degrees it is interpolated by 1, cos 2a, sin 2a and cos 4a. */
void rotationMatrix(const Rotation& rotation, float matrix[BOX_LANES][BOX_LANES])
{
    const double c = rotation.cosine, s = rotation.sine;
    const double c2 = c * c - s * s, s2 = 2 * s * c, c4 = c2 * c2 - s2 * s2;
    const double diagonal = 0.70710678118654752;  // of a step to |gx + gy|
    const double even = (1 + c4) / 4, odd = (1 - c4) / 4;
    std::fill(&matrix[0][0], &matrix[0][0] + BOX_LANES * BOX_LANES, 0.f);
    matrix[LANE_ABSOLUTE_X][LANE_ABSOLUTE_X] = matrix[LANE_ABSOLUTE_Y][LANE_ABSOLUTE_Y] =
            (float)(even + c2 / 2);
    matrix[LANE_ABSOLUTE_Y][LANE_ABSOLUTE_X] = matrix[LANE_ABSOLUTE_X][LANE_ABSOLUTE_Y] =
            (float)(even - c2 / 2);
    matrix[LANE_ABSOLUTE_SUM][LANE_ABSOLUTE_X] = matrix[LANE_ABSOLUTE_DIFFERENCE][LANE_ABSOLUTE_Y] =
            (float)((odd + s2 / 2) * diagonal);
    matrix[LANE_ABSOLUTE_DIFFERENCE][LANE_ABSOLUTE_X] = matrix[LANE_ABSOLUTE_SUM][LANE_ABSOLUTE_Y] =
            (float)((odd - s2 / 2) * diagonal);
    matrix[LANE_GRADIENT_X][LANE_GRADIENT_X] = matrix[LANE_GRADIENT_Y][LANE_GRADIENT_Y] = (float)c;
    matrix[LANE_GRADIENT_Y][LANE_GRADIENT_X] = (float)s;
    matrix[LANE_GRADIENT_X][LANE_GRADIENT_Y] = (float)-s;
    matrix[LANE_INTENSITY][LANE_INTENSITY] = 1;
}

template <typename Sum> typename BoxMeansFunc<Sum>::Type meansOf(const BoxKernels& kernels);
template <> BoxMeansFunc<unsigned>::Type meansOf<unsigned>(const BoxKernels& kernels)
{
    return kernels.means;
}
template <> BoxMeansFunc<int64>::Type meansOf<int64>(const BoxKernels& kernels) { return kernels.longMeans; }

//! Cells along the side of a box, at least one.
double cellsInSide(double side, int in80ths)
{
    return std::max(std::floor(side * in80ths / (80 * BOX_CELL) + 0.5), 1.);
}

template <typename T, typename Sum>
void describeBatch(const DescriptorPlan& plan, const Mat& image, const KeyPointBatch& batch,
        const std::vector<SupportRegion>& regions, const std::vector<KeyPoint>& keypoints,
        const std::vector<float>& angles, typename SumCellRowFunc<T, Sum>::Type sumRow, Workspace& workspace,
        Mat& descriptors)
{
    const BoxPlan& boxes = *plan.boxes;
    const BoxKernels& kernels = plan.kernels.boxes;
    const int border = plan.parameters.border;
    const std::vector<Channel> source = {{IIB::CHANNEL_SIGNED_GRAD_X, image},
            {IIB::CHANNEL_SIGNED_GRAD_Y, image}, {IIB::CHANNEL_INTENSITY, image}};
    CellBand<T, Sum> band(source, batch.area, batch.rows + KeyPointBatch::BAND_ROWS, plan.kernels, sumRow,
            workspace.channelRows, workspace.planes, workspace.integralRing);
    float* const means = workspace.boxMeans.get<float>(MAX_BOXES * BOX_LANES);
    BoxPlaces& places = workspace.boxPlaces;
    BoxFrame frame;
    frame.bounds = cellsOf(boundsOf(border, image.size()));
    frame.step = band.step();
    float matrix[BOX_LANES][BOX_LANES];

    for (int k : batch.keypoints)
    {
        const bool rotated = angles[k] >= 0;
        const Rotation rotation(rotated ? angles[k] : 0);
        const double side = regions[k].side, sideInCells = side / BOX_CELL;
        band.advance(
                batch.bandEnd(boxPixels(regions[k], keypoints[k].pt, rotated, border, image.size()).br().y));
        frame.origin = band.origin();
        frame.x = (keypoints[k].pt.x + 0.5) / BOX_CELL;
        frame.y = (keypoints[k].pt.y + 0.5) / BOX_CELL;
        frame.cosine = rotation.cosine * sideInCells;
        frame.sine = rotation.sine * sideInCells;
        for (const BoxPlan::Level& level : boxes.levels)
        {
            frame.side = cellsInSide(side, level.side);
            kernels.places(frame, boxes.x.data(), boxes.y.data(), level.first, level.end, places);
        }
        meansOf<Sum>(kernels)(band.data(), places, boxes.boxes(), means);
        if (rotated)
        {
            rotationMatrix(rotation, matrix);
            kernels.rotate(matrix, boxes.boxes(), means);
        }
        for (const BoxPlan::Level& level : boxes.levels)
            kernels.bits(means, level.comparisons, descriptors.ptr(k));
    }
}

//! Whether 32 bits hold the sums over all boxes of a batch of 8-bit pixels.
bool sumsAreShort(const BoxPlan& plan, const KeyPointBatch& batch, const std::vector<SupportRegion>& regions)
{
    const double largest = 6 * 255 * BOX_CELL * BOX_CELL;  // |gx + gy| of a cell
    double cells = 0;
    for (int k : batch.keypoints)
        cells = std::max(cells, cellsInSide(regions[k].side, plan.levels[0].side));
    return largest * cells * cells <= INT_MAX;
}

}  // namespace

Rect boxPixels(const SupportRegion& region, Point2f centre, bool rotated, int border, Size image)
{
    // corners of the outermost grids, whose boxes do not turn; four pixels more for roundings
    const SupportRegion extent(centre, region.side * (rotated ? 1.25 : 1) + 8);
    const Rect cells = cellsOf(extent.pixels(boundsOf(border, image)));
    return Rect(cells.tl() * (int)BOX_CELL, cells.size() * (int)BOX_CELL);
}

void describeBoxes(const DescriptorPlan& plan, const Mat& image, const KeyPointBatch& batch,
        const std::vector<SupportRegion>& regions, const std::vector<KeyPoint>& keypoints,
        const std::vector<float>& angles, Workspace& workspace, Mat& descriptors)
{
    const BoxKernels& k = plan.kernels.boxes;
    if (image.depth() == CV_16U)
        describeBatch<int, int64>(
                plan, image, batch, regions, keypoints, angles, k.sumIntRow, workspace, descriptors);
    else if (sumsAreShort(*plan.boxes, batch, regions))
        describeBatch<short, unsigned>(
                plan, image, batch, regions, keypoints, angles, k.sumShortRow, workspace, descriptors);
    else
        describeBatch<short, int64>(
                plan, image, batch, regions, keypoints, angles, k.sumLongRow, workspace, descriptors);
}

}  // namespace iib
}  // namespace cv
