// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#ifndef OPENCV_IIB_DESCRIPTOR_LAYOUT_HPP
#define OPENCV_IIB_DESCRIPTOR_LAYOUT_HPP

#include <array>
#include <cstring>

#include "parameters.hpp"

namespace cv {
namespace iib {

enum
{
    GROUP_CHANNELS = 4
};  //!< channels that integral images and kernels carry side by side

//! Bits of a level before it is padded to whole bytes; the order of the bits is in descriptor.hpp.
int levelBits(const Parameters& parameters, int level);

//! Bytes of each level that has any, coarse first.
std::vector<int> levelBytes(const Parameters& parameters);

//! The finest level that has any bit.
int finestLevel(const Parameters& parameters);

//! The place of a group's first bit of a level in the descriptor.
int bitOffset(const Parameters& parameters, int level, int group);

//! Stores the lowest bytes of a word, the lowest first.
inline void storeBytes(uint64 word, int bytes, uchar* out)
{
#ifdef WORDS_BIGENDIAN
    for (int i = 0; i < bytes; i++)
        out[i] = (uchar)(word >> 8 * i);
#else
    memcpy(out, &word, bytes);
#endif
}

//! Eight bytes, the lowest first.
inline uint64 loadWord(const uchar* in)
{
    uint64 word = 0;
#ifdef WORDS_BIGENDIAN
    for (int i = 0; i < 8; i++)
        word |= (uint64)in[i] << 8 * i;
#else
    memcpy(&word, in, 8);
#endif
    return word;
}

//! Appends bits to a descriptor, the lowest bit of the lowest byte first. Writes only bytes that get bits.
class BitWriter
{
public:
    //! Bits of the first byte below the offset are kept.
    BitWriter(uchar* descriptor, int offset)
        : next(descriptor + offset / 8), pending(offset % 8 ? *next : 0), count(offset % 8)
    {
    }

    //! The low n bits of `bits`, n = 0..64; higher bits must be zero.
    void append(uint64 bits, int n)
    {
        pending |= bits << count;
        count += n;
        if (count < 64)
            return;
        storeBytes(pending, 8, next);
        next += 8;
        count -= 64;
        pending = count ? bits >> (n - count) : 0;
    }

    //! Room for n whole bytes, or null if the bits so far end within a byte. Nothing is pending at the start.
    uchar* reserve(int n)
    {
        if (count != 0)
            return 0;
        next += n;
        return next - n;
    }

    //! Writes the bits still pending; call it once, at the end.
    void flush()
    {
        for (; count > 0; count -= 8, pending >>= 8)
            *next++ = (uchar)pending;
    }

private:
    uchar* next;
    uint64 pending;
    int count;  //!< bits pending, 0..63
};

}  // namespace iib
}  // namespace cv

#endif
