// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#include "bands.hpp"
#include "batch_job.hpp"

namespace cv { namespace iib {

namespace {

/** The last rows of an integral image over squares of BOX_SQUARE x BOX_SQUARE pixels, from the top of a rectangle of the
 image, reflected at its border, to its bottom. */
template <typename T> class SquareBand
{
public:
    typedef typename BoxSumKernels<T>::Sum Sum;

    //! @param source gx, gy and intensity of the image; outlives the band, as do the kernels and the workspace.
    //! @param area of whole squares. @param rows number of pixel rows that stay readable, including the newest.
    SquareBand(const std::vector<Channel>& source, Rect area, int rows, const DescriptorPlan& plan,
            bool rotated, Workspace& workspace)
        : channelRows(source, area, 0, plan.kernels.pixels(T()).rows, workspace.channelRows),
          sumRow(plan.boxes.kernels.sums(T()).sumRow[rotated]), width(area.width / BOX_SQUARE),
          ring(area.tl() / BOX_SQUARE, std::min(rows / BOX_SQUARE + 2, area.height / BOX_SQUARE + 1),
                  ((size_t)width + 1) * BOX_LANES, BOX_LANES, workspace.ring),
          planes(workspace.planes.get<T>(BOX_SQUARE * channelRows.rowSize()))
    {
    }

    //! Adds the image's rows before `end`, which never decreases.
    void advance(int end)
    {
        ring.advance(end / BOX_SQUARE, [&](int y, const Sum* above, Sum* out) {
            const T* rows[BOX_SQUARE][BOX_PLANES];
            for (int r = 0; r < BOX_SQUARE; r++)
            {
                T* const row = planes + r * channelRows.rowSize();
                channelRows.compute(y * BOX_SQUARE + r, row);
                for (int i = 0; i < BOX_PLANES; i++)
                    rows[r][i] = row + channelRows.places()[i];
            }
            sumRow(rows, width, above, out);
        });
    }

    const RingRows<Sum>& integral() const { return ring.rows(); }

    //! The oldest row of squares in the ring.
    int oldest() const { return ring.oldest(); }

private:
    ChannelRows<T> channelRows;
    void (*const sumRow)(
            const T* const rows[BOX_SQUARE][BOX_PLANES], int squares, const Sum* above, Sum* out);
    const int width;  //!< in squares
    RowRing<Sum> ring;
    T* const planes;
};

/* The matrix that rotates means; a row for each lane that is read. The mean of |gx cos a + gy sin a| has period 180 degrees.
 It is interpolated from its values at 0, 45, 90 and 135 degrees by 1, cos 2a, sin 2a and cos 4a. */
void rotationMatrix(const Rotation& rotation, float matrix[BOX_LANES][BOX_LANES])
{
    const double c = rotation.cosine, s = rotation.sine;
    const double c2 = c * c - s * s, s2 = 2 * s * c, c4 = c2 * c2 - s2 * s2;
    const double diagonal =
            0.70710678118654752;  // |gx + gy| is sqrt(2) times the magnitude along the diagonal
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
    matrix[LANE_GRADIENT_X][LANE_GRADIENT_SUM] = (float)(c - s);
    matrix[LANE_GRADIENT_Y][LANE_GRADIENT_SUM] = (float)(c + s);
    matrix[LANE_GRADIENT_X][LANE_GRADIENT_X_AGAIN] = (float)c;
    matrix[LANE_GRADIENT_Y][LANE_GRADIENT_X_AGAIN] = (float)s;
    matrix[LANE_INTENSITY][LANE_INTENSITY] = 1;
}

//! Squares along the side of a rotated keypoint's box, at least one.
double squaresInSide(double side, const BoxPlan::Level& level)
{
    return std::max(std::floor(side / BOX_SQUARE * level.side + 0.5), 1.);
}

template <typename T> void describeBatch(const BatchJob& job)
{
    const DescriptorPlan& plan = job.plan;
    const KeyPointBatch& batch = job.batch;
    const Mat& grey = job.grey;
    const bool rotated = job.regions[batch.keypoints[0]].isRotated();
    const BoxKernels& kernels = plan.boxes.kernels;
    const BoxSumKernels<T>& sums = kernels.sums(T());
    const std::vector<Channel> source = {{IIB::CHANNEL_SIGNED_GRAD_X, grey},
            {IIB::CHANNEL_SIGNED_GRAD_Y, grey}, {IIB::CHANNEL_INTENSITY, grey}};
    SquareBand<T> band(
            source, batch.area, batch.rows + KeyPointBatch::BAND_ROWS, plan, rotated, job.workspace);
    const auto& integral = band.integral();
    T* const means = job.workspace.boxMeans.get<T>(MAX_BOX_MEANS);
    BoxFrame frame;
    frame.bounds = boxBounds(plan.parameters.border, grey.size());
    frame.left = integral.origin.x;
    frame.count = integral.count;
    BoxEdges edges;
    BoxPlaces& places = job.workspace.boxPlaces;
    const Rotation upright(0);
    float matrix[BOX_LANES][BOX_LANES];
    for (int k : batch.keypoints)
    {
        const SupportRegion& region = job.regions[k];
        const Rotation rotation = rotated ? Rotation(region.angle) : upright;
        band.advance(batch.bandEnd(job.pixels[k].br().y));
        frame.centre = Point2d((region.centre.x + 0.5) / BOX_SQUARE, (region.centre.y + 0.5) / BOX_SQUARE);
        frame.side = region.side / BOX_SQUARE;
        frame.shift = integral.shift(band.oldest());
        if (rotated)
            rotationMatrix(rotation, matrix);
        else
            kernels.edges(frame, plan.boxes.edges, edges);
        for (const BoxPlan::Level& level : plan.boxes.levels)
        {
            if (rotated)
            {
                kernels.places(frame, level.shape, level.centres.data(),
                        Point2d(rotation.cosine, rotation.sine), squaresInSide(region.side, level),
                        (int)integral.step / BOX_LANES, places);
                sums.rotatedMeans(integral, level.shape, places, matrix, means);
            }
            else
                sums.means(integral, level.shape, edges, means);
            sums.bits(means, level.shape, level.chosen, level.offset, job.descriptors.ptr(k));
        }
    }
}

//! Whether 32 bits hold the sums over all boxes of a batch of 8-bit pixels.
bool sumsAreShort(const BatchJob& job)
{
    const double largest = 6 * 255 * BOX_SQUARE * BOX_SQUARE;  // |gx + gy| of a square
    double squares = 0;
    for (int k : job.batch.keypoints)
        squares = std::max(squares, squaresInSide(job.regions[k].side, job.plan.boxes.levels[0]) + 1);
    return largest * squares * squares <= INT_MAX;
}

}  // namespace

void describeBoxes(const BatchJob& job)
{
    (job.grey.depth() == CV_8U && sumsAreShort(job) ? describeBatch<short> : describeBatch<int>)(job);
}

}}  // namespace cv::iib
