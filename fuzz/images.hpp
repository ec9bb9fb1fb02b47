// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "byte_source.hpp"

#include <cstring>

namespace fuzz {

using namespace cv;

inline Size drawSize(ByteSource& in)
{
    // small for speed; some are wider than a vector of 32, or higher than a band of rows
    const int largest = in.rarely(8) ? in.rarely(32) ? 300 : 70 : 12;
    const int width = in.between(0, largest);
    return Size(width, in.between(0, largest));
}

//! Pixels of any type: noise, ramps, flat areas, extremes, and in floats a rare NaN or infinity.
inline Mat drawImage(ByteSource& in, Size size, int depth, int channels)
{
    Mat image(size, CV_MAKETYPE(depth, channels));
    const int kind = in.between(0, 7);
    RNG rng(in.read<ushort>());
    if (image.empty())
        return image;
    if (kind < 3)
        rng.fill(image, RNG::UNIFORM, depth == CV_8S || depth == CV_16S ? -100 : 0,
                depth % 8 < 2 ? 256 : 65536);
    else if (kind < 5)
        for (int y = 0; y < image.rows; y++)
            image.row(y).setTo(Scalar::all(kind == 3 ? y * 7 % 256 : (y & 1) * 65535));
    else
        image.setTo(Scalar::all(kind == 5 ? 0 : 65535));
    if (depth == CV_32F && in.between(0, 3) == 0)
        for (int i = in.between(0, 3); i > 0; i--)
            image.ptr<float>(in.between(0, size.height - 1))[in.between(0, size.width * channels - 1)] =
                    in.number();
    // A view into a larger matrix, whose rows are not contiguous.
    if (!in.flag())
        return image;
    const Rect inside(Point(in.between(0, 9), in.between(0, 9)), size);
    Mat whole(size + Size(inside.x + 3, inside.y + 3), image.type());
    std::memset(whole.data, 99, whole.total() * whole.elemSize());
    image.copyTo(whole(inside));
    return whole(inside);
}

//! A depth that the library accepts.
inline int drawDepth(ByteSource& in)
{
    const int depths[] = {CV_8U, CV_8U, CV_16U, CV_32F};
    return depths[in.between(0, 3)];
}

//! @param odd whether to draw any type, which the library may refuse.
inline Mat drawImage(ByteSource& in, Size size, bool odd)
{
    const int channels[] = {1, 1, 3, 4};
    const int depth = odd ? in.between(0, 7) : drawDepth(in);
    return drawImage(in, size, depth, odd ? in.between(1, 4) : channels[in.between(0, 3)]);
}

inline bool isMap(const Mat& m)
{
    // m * 0, since checkRange() treats the largest float as infinity.
    return (m.depth() == CV_8U || m.depth() == CV_16U || m.depth() == CV_32F) &&
           (m.empty() || checkRange(m * 0));
}

inline bool isImage(const Mat& m) { return isMap(m) && m.channels() != 2 && m.channels() <= 4; }

}  // namespace fuzz
