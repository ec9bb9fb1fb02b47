// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#include "integral.hpp"

#include "opencv2/core/hal/intrin.hpp"
#include "opencv2/imgproc.hpp"

namespace cv { namespace iib {

namespace {

constexpr int PADDING = 64;  //!< pixels that vectors may read and write past the end of a row

//! Grey by whole numbers, since cvtColor may round in different ways. With room for PADDING pixels right of each row.
Mat greyOf(const Mat& image)
{
    const Mat padded(image.rows, image.cols + PADDING, CV_8U);
    Mat grey = padded.colRange(0, image.cols);
    const int channels = image.channels();
    for (int y = 0; y < image.rows; y++)
    {
        const uchar* in = image.ptr(y);
        uchar* const out = grey.ptr(y);
        if (channels == 1)
            std::copy_n(in, image.cols, out);
        else
            for (int x = 0; x < image.cols; x++, in += channels)
                out[x] = (uchar)((3735 * in[0] + 19235 * in[1] + 9798 * in[2] + (1 << 14)) >> 15);
    }
    return grey;
}

Mat sobelOf(const Mat& grey, int dx)
{
    Mat padded(grey.rows, grey.cols + PADDING, CV_16S), gradient = padded.colRange(0, grey.cols);
    Sobel(grey, gradient, CV_16S, dx, 1 - dx, 3, 1, 0,
            BORDER_REPLICATE | BORDER_ISOLATED);  // not the padding
    return gradient;
}

/* Whether a compiler fuses products with sums changes the result of no gradient of 8-bit images. */
#if CV_SIMD && CV_SIMD_64F  // not ARMv7, which divides and rounds in another way
inline v_int32 octantSteps(const v_int32& shortSide, const v_int32& longSide)
{
    const v_float32 t = v_div(v_cvt_f32(shortSide), v_cvt_f32(longSide)), t2 = v_mul(t, t);
    const v_float32 inner = v_add(v_mul(vx_setall_f32(ATAN_C), t2), vx_setall_f32(ATAN_B));
    return v_round(v_mul(v_add(v_mul(inner, t2), vx_setall_f32(ATAN_A)), t));
}

inline v_int16 orientation(const v_int16& gx, const v_int16& gy, const v_int16& ax, const v_int16& ay)
{
    v_int32 shortSides[2], longSides[2];
    v_expand(v_min(ax, ay), shortSides[0], shortSides[1]);
    v_expand(v_max(v_max(ax, ay), vx_setall_s16(1)), longSides[0], longSides[1]);
    v_int16 s = v_pack(octantSteps(shortSides[0], longSides[0]), octantSteps(shortSides[1], longSides[1]));
    const auto mirror = [&s](const v_int16& where, int steps) {
        s = v_select(where, v_sub(vx_setall_s16((short)steps), s), s);
    };
    mirror(v_lt(ax, ay), ORIENTATION_STEPS / 4);
    mirror(v_lt(gx, vx_setzero_s16()), ORIENTATION_STEPS / 2);
    mirror(v_gt(gy, vx_setzero_s16()), ORIENTATION_STEPS);
    return v_and(s, vx_setall_s16(ORIENTATION_STEPS - 1));
}
#else
//! atan2(-gy, gx) in ORIENTATION_STEPS a turn.
short orientation(int gx, int gy)
{
    const float ax = (float)std::abs(gx), ay = (float)std::abs(gy);
    const float t = std::min(ax, ay) / std::max(std::max(ax, ay), 1.f), t2 = t * t;
    int steps = cvRound(((ATAN_C * t2 + ATAN_B) * t2 + ATAN_A) * t);
    if (ax < ay)
        steps = ORIENTATION_STEPS / 4 - steps;
    if (gx < 0)
        steps = ORIENTATION_STEPS / 2 - steps;
    if (gy > 0)
        steps = ORIENTATION_STEPS - steps;
    return (short)(steps & (ORIENTATION_STEPS - 1));
}
#endif

//! The channels of a row of the image, side by side in each pixel. Rows have room for PADDING pixels more.
void channelRow(const short* dx, const short* dy, const uchar* grey, int width, short* out)
{
#if CV_SIMD && CV_SIMD_64F
    const int step = VTraits<v_int16>::vlanes();
    for (int x = 0; x < width; x += step)
    {
        const v_int16 gx = vx_load(dx + x), gy = vx_load(dy + x);
        const v_int16 ax = v_reinterpret_as_s16(v_abs(gx)), ay = v_reinterpret_as_s16(v_abs(gy));
        v_store_interleave(out + CHANNELS * x, ax, ay, orientation(gx, gy, ax, ay),
                v_reinterpret_as_s16(vx_load_expand(grey + x)));
    }
    vx_cleanup();
#else
    for (int x = 0; x < width; x++, out += CHANNELS)
    {
        out[0] = (short)std::abs(dx[x]);
        out[1] = (short)std::abs(dy[x]);
        out[2] = orientation(dx[x], dy[x]);
        out[3] = grey[x];
    }
#endif
}

//! out = above + the sums along a row; both begin with the zeros left of it. @param places of its pixels in the image.
void sumRow(const short* channels, const std::vector<int>& places, const int* above, int* out)
{
    std::fill_n(out, CHANNELS, 0);
#if CV_SIMD128
    v_int32x4 sum = v_setzero_s32();
    for (int place : places)
    {
        above += CHANNELS;
        out += CHANNELS;
        sum = v_add(sum, v_load_expand(channels + CHANNELS * (size_t)place));
        v_store(out, v_add(sum, v_load(above)));
    }
#else
    unsigned sum[CHANNELS] = {};
    for (int place : places)
    {
        above += CHANNELS;
        out += CHANNELS;
        for (int c = 0; c < CHANNELS; c++)
        {
            sum[c] += channels[CHANNELS * (size_t)place + c];
            out[c] = (int)(sum[c] + (unsigned)above[c]);
        }
    }
#endif
}

}  // namespace

Mat integralOf(const Mat& image, Rect area)
{
    const Mat grey = greyOf(image), dx = sobelOf(grey, 1), dy = sobelOf(grey, 0);
    std::vector<int> places(area.width);
    for (int x = 0; x < area.width; x++)
        places[x] = borderInterpolate(area.x + x, image.cols, BORDER_REFLECT_101);
    std::vector<short> channels(CHANNELS * ((size_t)image.cols + PADDING));
    Mat sums(area.height + 1, area.width + 1, CV_32SC4);
    sums.row(0).setTo(Scalar::all(0));
    for (int y = 0; y < area.height; y++)
    {
        const int row = borderInterpolate(area.y + y, image.rows, BORDER_REFLECT_101);
        channelRow(dx.ptr<short>(row), dy.ptr<short>(row), grey.ptr(row), image.cols, channels.data());
        sumRow(channels.data(), places, sums.ptr<int>(y), sums.ptr<int>(y + 1));
    }
    return sums;
}

}}  // namespace cv::iib
