// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#pragma once

#include <cstring>
#include <numeric>

#include "../../precomp.hpp"

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

//! The bits in use of a phase of quads or of a level of boxes (paper, "Reduction of the IIB Descriptor Size"), in their order.
class ChosenBits
{
public:
    //! Up to SIZE bits within SIZE bytes of comparisons.
    struct Group
    {
        static constexpr int SIZE = 16;
        size_t byte;  //!< the first byte
        int count;
        uchar places[SIZE];  //!< byte of each bit, relative to the first; 128: no bit
        uchar masks[SIZE];   //!< the bit in its byte; 1: no bit
    };

    //! @param masks a bit for each comparison, in their order.
    explicit ChosenBits(const std::vector<uint64>& masks)
        : whole(std::count(masks.begin(), masks.end(), ~(uint64)0) == (ptrdiff_t)masks.size())
    {
        for (size_t bit = 0; bit < 64 * masks.size(); bit++)
        {
            if (!(masks[bit / 64] >> bit % 64 & 1))
                continue;
            const size_t byte = bit / 8;
            if (none() || chosen.back().count == Group::SIZE || byte - chosen.back().byte >= Group::SIZE)
            {
                Group next = {byte, 0, {}, {}};
                std::fill_n(next.places, (int)Group::SIZE, (uchar)128);
                std::fill_n(next.masks, (int)Group::SIZE, (uchar)1);
                chosen.push_back(next);
            }
            Group& group = chosen.back();
            group.places[group.count] = (uchar)(byte - group.byte);
            group.masks[group.count++] = (uchar)(1 << bit % 8);
        }
    }

    bool none() const { return chosen.empty(); }
    int count() const
    {
        return std::accumulate(chosen.begin(), chosen.end(), 0,
                [](int bits, const Group& group) { return bits + group.count; });
    }
    //! Whether all comparisons are in use: then the descriptor is a copy of them.
    bool all() const { return whole; }
    const std::vector<Group>& groups() const { return chosen; }

private:
    bool whole;
    std::vector<Group> chosen;
};

}}  // namespace cv::iib
