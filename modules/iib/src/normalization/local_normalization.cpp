// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#include "local_normalization.hpp"

#include "kernels/kernels.hpp"

#include <array>

namespace cv { namespace iib {

namespace {

template <typename T> using HalveFunc = void (*)(const T* const rows[4], T* half, int halfWidth);

//! The blurs at the smallest size: `passes` times (weight, 256 - 2 weight, weight) / 256.
struct Blurs
{
    int levels, passes, weight;

    /* Halving and interpolating add 3/4 of a squared pixel each, in pixels of the larger size: all levels add
     (4^levels - 1) / 2. A pass adds weight / 128. Weights above 256 / 3 would have more than one peak. */
    explicit Blurs(double sigma) : levels(std::max((int)std::floor(std::log2(sigma)), 1))
    {
        const double scale = std::pow(4., levels);
        const double variance = std::max(sigma * sigma - (scale - 1) / 2, 0.) / scale;
        passes = cvCeil(variance * 1.5);
        weight = passes > 0 ? cvRound(128 * variance / passes) : 0;
    }
};

const double ROWS_OF_A_THREAD = 64;  // fewer rows are not worth a thread

class Normalizer
{
public:
    Normalizer(const Mat& grey_, double sigma)
        : kernels(filterKernels()), grey(grey_), blurs(sigma), size(grey.size()), factor(0)
    {
        sizes.push_back(size);
        for (int i = 0; i < blurs.levels; i++)
            sizes.push_back(Size((sizes.back().width + 1) / 2, (sizes.back().height + 1) / 2));
        double largest = 255;
        if (grey.depth() == CV_16U)
            minMaxIdx(grey, 0, &largest);
        if (largest > 0)
            factor = cvRound(WHITE * 65536. / largest);
    }

    Mat run() const
    {
        const PaddedRows<short> means = meansAtHalf(), gains = gainsAtHalf(means);
        Mat result(size, CV_8U);
        forRows(size.height, [&](int y, Scratch& scratch) {
            short *differences = scratch.window.row(0), *gain = scratch.row.row(0);
            makeDifferences(y, means, scratch, differences);
            upsampleRow(gains, y, scratch.between, gain);
            kernels.scale(differences, gain, result.ptr(y), size.width);
        });
        return result;
    }

private:
    template <typename T> using FourRows = std::array<const T*, 4>;

    //! Rows of a thread.
    struct Scratch
    {
        PaddedRows<short> window;        //!< the last four rows
        PaddedRows<short> row, between;  //!< a row, and one with half as many values
        int next;                        //!< the next row of `window` to make

        explicit Scratch(Size size)
            : window(Size(size.width + 1, 4)), row(Size(size.width + 1, 1)), between(Size(size.width + 1, 1)),
              next(0)
        {
        }
    };

    //! Calls work(y, scratch) for all rows, from several threads.
    template <typename Work> void forRows(int rows, const Work& work) const
    {
        parallel_for_(
                Range(0, rows),
                [&](const Range& range) {
                    Scratch scratch(size);
                    for (int y = range.start; y < range.end; y++)
                        work(y, scratch);
                },
                rows / ROWS_OF_A_THREAD);
    }

    //! Row y of the image.
    void readRow(int y, short* out) const
    {
        if (grey.depth() == CV_8U)
            return kernels.widen(grey.ptr(y), out, grey.cols);
        const ushort* values = grey.ptr<ushort>(y);
        for (int x = 0; x < grey.cols; x++)
            out[x] = (short)(((int64)values[x] * factor + 32768) >> 16);
    }

    //! Row y of I - G*I.
    void makeDifferences(int y, const PaddedRows<short>& means, Scratch& scratch, short* out) const
    {
        short* const mean = scratch.row.row(0);
        readRow(y, out);
        upsampleRow(means, y, scratch.between, mean);
        kernels.subtract(out, mean, out, size.width);
    }

    //! The rows around row y of half the size, computed by make(row, out). Calls come in the order of y.
    template <typename Make> FourRows<short> rowsAround(int y, Scratch& scratch, const Make& make) const
    {
        FourRows<short> rows;
        for (int i = 0; i < 4; i++)
        {
            const int row = within(2 * y + i - 1, size.height);
            if (row >= scratch.next)
            {
                make(row, scratch.window.row(row));
                scratch.window.repeatEnds(row, size.width, 2);
                scratch.next = row + 1;
            }
            rows[i] = scratch.window.row(row);
        }
        return rows;
    }

    //! G*I at half the image's size.
    PaddedRows<short> meansAtHalf() const
    {
        PaddedRows<short> halves(sizes[1]);
        forRows(halves.size.height, [&](int y, Scratch& scratch) {
            const auto rows = rowsAround(y, scratch, [&](int row, short* out) { readRow(row, out); });
            kernels.halveShorts(rows.data(), halves.row(y), halves.size.width);
        });
        PaddedRows<short> smallest = reduced(std::move(halves), 1, kernels.halveShorts);
        PaddedRows<int> sums(smallest.size);
        for (int y = 0; y < sums.size.height; y++)
            std::copy_n(smallest.row(y), sums.size.width, sums.row(y));
        blur(sums);
        for (int y = 0; y < sums.size.height; y++)
            std::copy_n(sums.row(y), sums.size.width, smallest.row(y));
        return upsampled(std::move(smallest), blurs.levels);
    }

    //! The factors of differences, at half the image's size.
    PaddedRows<short> gainsAtHalf(const PaddedRows<short>& means) const
    {
        PaddedRows<int> halves(sizes[1]);
        forRows(halves.size.height, [&](int y, Scratch& scratch) {
            const auto rows = rowsAround(
                    y, scratch, [&](int row, short* out) { makeDifferences(row, means, scratch, out); });
            kernels.halveSquares(rows.data(), halves.row(y), halves.size.width);
        });
        PaddedRows<int> variances = reduced(std::move(halves), 1, kernels.halveInts);
        blur(variances);
        PaddedRows<short> gains(variances.size);
        for (int y = 0; y < gains.size.height; y++)
            kernels.gain(variances.row(y), gains.row(y), gains.size.width);
        return upsampled(std::move(gains), blurs.levels);
    }

    static int within(int y, int height) { return std::min(std::max(y, 0), height - 1); }

    //! The rows that row y of half the plane's size depends on.
    template <typename T> static FourRows<T> rowsAround(const PaddedRows<T>& plane, int y)
    {
        FourRows<T> rows;
        for (int i = 0; i < 4; i++)
            rows[i] = plane.row(within(2 * y + i - 1, plane.size.height));
        return rows;
    }

    //! From sizes[level] down to the smallest.
    template <typename T> PaddedRows<T> reduced(PaddedRows<T> plane, int level, HalveFunc<T> halve) const
    {
        if (level == blurs.levels)
            return plane;
        PaddedRows<T> half(sizes[level + 1]);
        for (int y = 0; y < plane.size.height; y++)
            plane.repeatEnds(y, plane.size.width, 2);
        for (int y = 0; y < half.size.height; y++)
            halve(rowsAround(plane, y).data(), half.row(y), half.size.width);
        return reduced(std::move(half), level + 1, halve);
    }

    //! From sizes[level] up to half the image's size.
    PaddedRows<short> upsampled(PaddedRows<short> plane, int level) const
    {
        if (level == 1)
            return plane;
        PaddedRows<short> larger(sizes[level - 1]), between(Size(plane.size.width + 1, 1));
        for (int y = 0; y < larger.size.height; y++)
            upsampleRow(plane, y, between, larger.row(y));
        return upsampled(std::move(larger), level - 1);
    }

    void blur(PaddedRows<int>& plane) const
    {
        const int width = plane.size.width, height = plane.size.height;
        PaddedRows<int> out(plane.size);
        for (int pass = 0; pass < blurs.passes; pass++)
        {
            for (int y = 0; y < height; y++)
            {
                plane.repeatEnds(y, width);
                const int* row = plane.row(y);
                kernels.blur(row - 1, row, row + 1, blurs.weight, out.row(y), width);
            }
            for (int y = 0; y < height; y++)
                kernels.blur(out.row(std::max(y - 1, 0)), out.row(y), out.row(std::min(y + 1, height - 1)),
                        blurs.weight, plane.row(y), width);
        }
    }

    //! Row y of twice the plane's size.
    void upsampleRow(const PaddedRows<short>& half, int y, PaddedRows<short>& between, short* out) const
    {
        const int width = half.size.width, other = y / 2 + (y % 2 ? 1 : -1);
        kernels.interpolate(
                half.row(y / 2), half.row(within(other, half.size.height)), between.row(0), width);
        between.repeatEnds(0, width);
        kernels.upsample(between.row(0), out, width);
    }

    const FilterKernels& kernels;
    const Mat& grey;
    const Blurs blurs;
    const Size size;          //!< of the image
    std::vector<Size> sizes;  //!< of all levels, the largest first
    int64 factor;             //!< for 16-bit pixels, in 2^-16
};

}  // namespace

Mat normalizeLocally(const Mat& grey, double sigma) { return Normalizer(grey, sigma).run(); }

}}  // namespace cv::iib
