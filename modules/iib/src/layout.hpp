// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#ifndef OPENCV_IIB_LAYOUT_HPP
#define OPENCV_IIB_LAYOUT_HPP

#include <array>

#include "parameters.hpp"

namespace cv {
namespace iib {

enum { GROUP_CHANNELS = 4 };  //!< channels that integral images and kernels carry side by side

//! Bits of a level before it is padded to whole bytes; the order of the bits is in descriptor.hpp.
int levelBits(const Parameters& parameters, int level);

//! Bytes of each level that has any, coarse first.
std::vector<int> levelBytes(const Parameters& parameters);

//! The place of a group's first bit of a level in the descriptor.
int bitOffset(const Parameters& parameters, int level, int group);

//! Appends bits to a zeroed descriptor, the lowest bit of the lowest byte first.
class BitWriter
{
public:
    BitWriter(uchar* descriptor, int offset) : next(descriptor + offset / 8), pending(*next), count(offset % 8) {}

    //! The low n bits of `bits`, n = 0..64; higher bits must be zero.
    void append(uint64 bits, int n)
    {
        pending |= bits << count;
        count += n;
        if (count < 64)
            return;
        for (int i = 0; i < 8; i++)  // a single store, where the machine is little-endian
            next[i] = (uchar)(pending >> 8 * i);
        next += 8;
        count -= 64;
        pending = count ? bits >> (n - count) : 0;
    }

    //! Writes the bits still pending; call it once, at the end.
    void flush()
    {
        for (int i = 0; i < (count + 7) / 8; i++)
            next[i] = (uchar)(pending >> 8 * i);
    }

private:
    uchar* next;
    uint64 pending;
    int count;  //!< bits pending, 0..63
};

}  // namespace iib
}  // namespace cv

#endif
