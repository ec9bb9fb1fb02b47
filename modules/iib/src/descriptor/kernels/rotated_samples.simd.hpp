// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#include "../../common/simd.hpp"

#include "orientation.hpp"
#include "rotated_samples.hpp"

namespace cv {
namespace iib {

CV_CPU_OPTIMIZATION_NAMESPACE_BEGIN

const RotatedSampleKernels<short>& shortRotatedSampleKernels();
const RotatedSampleKernels<int>& intRotatedSampleKernels();

#ifndef CV_CPU_OPTIMIZATION_DECLARATIONS_ONLY

namespace {

// The compiler makes vectors of the plain loops, with this file's instruction set.

void sampleIndices(const SampleGrid& g, int sub, int* index)
{
    const int n = g.n, cells = n / sub;
    for (int dy = 0; dy < sub; dy++)
        for (int dx = 0; dx < sub; dx++)
            for (int row = 0; row < cells; row++)
            {
                const int v = 2 * (row * sub + dy) + 1 - n;
                const int startX = g.fracX - v * g.stepY, startY = g.fracY + v * g.stepX;
                for (int parity = 0; parity < 2; parity++)
                {
                    const int first = 2 * (parity * sub + dx) + 1 - n;
                    for (int i = 0; i < cells / 2; i++)
                    {
                        const int u = first + 4 * sub * i;
                        const int x = g.x + ((startX + u * g.stepX) >> 17),
                                  y = g.y + ((startY + u * g.stepY) >> 17);
                        const int insideX = std::min(std::max(x, 0), g.image.width - 1);
                        const int insideY = std::min(std::max(y, 0), g.image.height - 1);
                        index[i] = (insideY - g.area.y) * g.area.width + insideX - g.area.x;
                    }
                    index += cells / 2;
                }
            }
}

void deinterleave(const short* p, v_int16 v[GROUP_CHANNELS])
{
    v_load_deinterleave(p, v[0], v[1], v[2], v[3]);
}

void deinterleave(const int* p, v_int32 v[GROUP_CHANNELS]) { v_load_deinterleave(p, v[0], v[1], v[2], v[3]); }

inline v_int16 vectorOf(short) { return vx_setzero_s16(); }
inline v_int32 vectorOf(int) { return vx_setzero_s32(); }

//! count must be a multiple of the vector.
template <typename T>
void gatherPixels(const T* pixels, const int* index, int count, T* const planes[GROUP_CHANNELS])
{
    typedef decltype(vectorOf(T())) V;
    const int lanes = VTraits<V>::max_nlanes;
    T chunk[GROUP_CHANNELS * VTraits<V>::max_nlanes];
    for (int i = 0; i < count; i += lanes)
    {
        for (int j = 0; j < lanes; j++)
            memcpy(chunk + j * GROUP_CHANNELS, pixels + (size_t)index[i + j] * GROUP_CHANNELS,
                    GROUP_CHANNELS * sizeof(T));
        V v[GROUP_CHANNELS];
        deinterleave(chunk, v);
        for (int c = 0; c < GROUP_CHANNELS; c++)
            v_store(planes[c] + i, v[c]);
    }
}

template <typename T> void rotateGradients(T* gx, T* gy, int count, int cosine, int sine)
{
    for (int i = 0; i < count; i++)
    {
        const int x = gx[i], y = gy[i];
        gx[i] = (T)((cosine * x + sine * y + 2048) >> 12);
        gy[i] = (T)((cosine * y - sine * x + 2048) >> 12);
    }
}

template <typename T> void turnOrientations(const T* gx, const T* gy, T* steps, int count, int turn)
{
    for (int i = 0; i < count; i++)
        steps[i] = (T)((gx[i] | gy[i]) == 0 ? 0 : (steps[i] + turn) & (ORIENTATION_STEPS - 1));
}

/* Sums over eight cells side by side: of `samples` values each, `step` apart, in a plane for each channel. The sums of
 shorts fit shorts, see describeTurned. */
void sumEightCells(const short* const planes[GROUP_CHANNELS], int start, int samples, int step, unsigned* out)
{
    v_int16x8 sums[GROUP_CHANNELS];
    for (int c = 0; c < GROUP_CHANNELS; c++)
    {
        sums[c] = v_load(planes[c] + start);
        for (int s = 1; s < samples; s++)
            sums[c] = sums[c] + v_load(planes[c] + start + s * step);
    }
    v_int16x8 even[2], odd[2],
            pairs[4];  // even and odd channels of half the cells; all channels of two cells
    v_zip(sums[0], sums[2], even[0], even[1]);
    v_zip(sums[1], sums[3], odd[0], odd[1]);
    for (int half = 0; half < 2; half++)
        v_zip(even[half], odd[half], pairs[2 * half], pairs[2 * half + 1]);
    for (int i = 0; i < 4; i++)
    {
        v_int32x4 first, second;
        v_expand(pairs[i], first, second);
        v_store(out + 2 * i * GROUP_CHANNELS, v_reinterpret_as_u32(first));
        v_store(out + (2 * i + 1) * GROUP_CHANNELS, v_reinterpret_as_u32(second));
    }
}

void sumEightCells(const int* const planes[GROUP_CHANNELS], int start, int samples, int step, unsigned* out)
{
    for (int half = 0; half < 8; half += 4)
    {
        v_int32x4 sums[GROUP_CHANNELS], cells[4];
        for (int c = 0; c < GROUP_CHANNELS; c++)
        {
            sums[c] = v_load(planes[c] + start + half);
            for (int s = 1; s < samples; s++)
                sums[c] = sums[c] + v_load(planes[c] + start + half + s * step);
        }
        v_transpose4x4(sums[0], sums[1], sums[2], sums[3], cells[0], cells[1], cells[2], cells[3]);
        for (int i = 0; i < 4; i++)
            v_store(out + (half + i) * GROUP_CHANNELS, v_reinterpret_as_u32(cells[i]));
    }
}

template <typename T>
void sumCells(const T* const planes[GROUP_CHANNELS], int n, int sub, CellGrid<unsigned>& cells)
{
    const int side = n / sub, count = side * side;
    cells.create(side);
    for (int row = 0; row < side; row++)
        for (int parity = 0; parity < 2; parity++)
        {
            const int start = (2 * row + parity) * (side / 2);
            for (int i = 0; i < side / 2; i += 8)
                sumEightCells(
                        planes, start + i, sub * sub, count, cells.row(row, parity) + i * GROUP_CHANNELS);
        }
}

template <typename T> const RotatedSampleKernels<T>& kernels()
{
    static const RotatedSampleKernels<T> k = {
            sampleIndices, gatherPixels<T>, rotateGradients<T>, turnOrientations<T>, sumCells<T>};
    return k;
}

}  // namespace

const RotatedSampleKernels<short>& shortRotatedSampleKernels() { return kernels<short>(); }

const RotatedSampleKernels<int>& intRotatedSampleKernels() { return kernels<int>(); }

#endif

CV_CPU_OPTIMIZATION_NAMESPACE_END

}  // namespace iib
}  // namespace cv
