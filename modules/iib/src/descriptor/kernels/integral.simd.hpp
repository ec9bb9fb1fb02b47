// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#ifndef OPENCV_IIB_DESCRIPTOR_KERNELS_INTEGRAL_SIMD_HPP
#define OPENCV_IIB_DESCRIPTOR_KERNELS_INTEGRAL_SIMD_HPP

#include "../../common/simd.hpp"
#include "kernels.hpp"

namespace cv {
namespace iib {

CV_CPU_OPTIMIZATION_NAMESPACE_BEGIN

namespace {

//! The plane's sums over each four pixels, from pixel x on.
inline v_uint16 loadSums(const short* plane, int x)
{
    return prefixSumsOfFour(v_reinterpret_as_u16(vx_load(plane + x)));
}

//! A vector (v_uint16) of pixels of four channels, side by side.
inline void interleave(const short* const planes[GROUP_CHANNELS], int x, v_uint16 pixels[4])
{
    const v_uint16 sums[GROUP_CHANNELS] = {
            loadSums(planes[0], x), loadSums(planes[1], x), loadSums(planes[2], x), loadSums(planes[3], x)};
    interleaveFour(sums, pixels);
}

void sumRow16(const short* const planes[GROUP_CHANNELS], int width, const ushort* above, ushort* out)
{
    const int step = VTraits<v_uint16>::max_nlanes, pixelsInVector = step / GROUP_CHANNELS;
    v_uint16 carry = vx_setzero_u16();
    for (int x = 0; x < width; x += step)
    {
        v_uint16 pixels[4];
        interleave(planes, x, pixels);
        for (int i = 0; i < 4; i++)
        {
            const int at = (x + i * pixelsInVector + 1) * GROUP_CHANNELS;
            const v_uint16 sums = v_add_wrap(addFourthToUpper(pixels[i]), carry);
            v_store(out + at, v_add_wrap(sums, vx_load(above + at)));
            if ((i + 1) * pixelsInVector % 4 == 0)
                carry = repeatLastFour(sums);
        }
    }
}

void sumRow32(const short* const planes[GROUP_CHANNELS], int width, const unsigned* above, unsigned* out)
{
    const int step = VTraits<v_uint16>::max_nlanes, pixelsInVector = step / GROUP_CHANNELS / 2;
    v_uint32 carry = vx_setzero_u32();
    for (int x = 0; x < width; x += step)
    {
        v_uint16 pixels[4];
        interleave(planes, x, pixels);
        for (int i = 0; i < 8; i += 2)
        {
            v_uint32 sums[2];
            v_expand(pixels[i / 2], sums[0], sums[1]);
            for (int j = 0; j < 2; j++)
            {
                const int at = (x + (i + j) * pixelsInVector + 1) * GROUP_CHANNELS;
                v_store(out + at, sums[j] + carry + vx_load(above + at));
                if ((i + j + 1) * pixelsInVector % 4 == 0)
                    carry = carry + repeatLastFour(sums[j]);
            }
        }
    }
}

//! Of 16-bit images, whose sums over four pixels exceed 16 bits. A pixel is one 128-bit vector here, on every machine.
void sumRowOf16Bit(const int* const planes[GROUP_CHANNELS], int width, const unsigned* above, unsigned* out)
{
    v_uint32x4 sum = v_setzero_u32();
    for (int x = 0; x < width; x++)
    {
        sum = sum + v_uint32x4((unsigned)planes[0][x], (unsigned)planes[1][x], (unsigned)planes[2][x],
                            (unsigned)planes[3][x]);
        v_store(out + 4 * (x + 1), sum + v_load(above + 4 * (x + 1)));
    }
}

}  // namespace

CV_CPU_OPTIMIZATION_NAMESPACE_END

}  // namespace iib
}  // namespace cv

#endif
