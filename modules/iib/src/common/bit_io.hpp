// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#pragma once

#include <cstring>

#include "../precomp.hpp"

namespace cv { namespace iib {

//! Stores the lowest bytes of a word, the lowest first.
inline void storeBytes(uint64 word, int bytes, uchar* out)
{
    memcpy(out, &word, bytes);  // all supported machines are little-endian
}

/** Appends bits, the lowest bit of the lowest byte first. The last, unfinished word stays pending until the end of the
 BitWriter. */
class BitAppender
{
public:
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

    //! Space for n whole bytes; null, and nothing changes, if bits are pending.
    uchar* reserve(int n)
    {
        if (count != 0)
            return 0;
        next += n;
        return next - n;
    }

protected:
    BitAppender(uchar* next_, uint64 pending_, int count_) : next(next_), pending(pending_), count(count_) {}

    uchar* next;
    uint64 pending;
    int count;  //!< bits pending, 0..63
};

//! Writes bits into a descriptor from an offset on. Changes only bytes that get bits.
class BitWriter : public BitAppender
{
public:
    //! Bits of the first byte below the offset are kept.
    BitWriter(uchar* descriptor, int offset)
        : BitAppender(descriptor + offset / 8,
                  offset % 8 ? descriptor[offset / 8] & ((1 << offset % 8) - 1) : 0, offset % 8)
    {
    }

    ~BitWriter()
    {
        for (; count > 0; count -= 8, pending >>= 8)
            *next++ = (uchar)pending;
    }

    BitWriter(const BitWriter&) = delete;
    BitWriter& operator=(const BitWriter&) = delete;
};

}}  // namespace cv::iib
