// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#pragma once

#include <memory>

#include "../precomp.hpp"

namespace cv { namespace iib {

constexpr int CACHE_LINE = 64;
//! Number of values that kernels may read and write past a row, and before a PaddedRows row.
constexpr int ROW_PADDING = 64;

//! n rounded up to fill whole cache lines of T.
template <typename T> inline size_t wholeLines(size_t n)
{
    return (n * sizeof(T) + CACHE_LINE - 1) / CACHE_LINE * CACHE_LINE / sizeof(T);
}

/** Values that begin on a cache line, so that no vector crosses one. Not initialized; moved but not copied. */
template <typename T> class AlignedBuffer
{
public:
    AlignedBuffer() : values(0), capacity(0) {}
    explicit AlignedBuffer(size_t n) : AlignedBuffer() { allocate(n); }
    AlignedBuffer(AlignedBuffer&& other)
        : memory(std::move(other.memory)), values(other.values), capacity(other.capacity)
    {
        other.capacity = 0;
    }

    //! Room for at least n values; the content is lost if it grows.
    void allocate(size_t n)
    {
        if (n <= capacity)
            return;
        memory.reset();
        capacity = 0;
        memory.reset(fastMalloc(n * sizeof(T) + CACHE_LINE));
        values = alignPtr(static_cast<T*>(memory.get()), CACHE_LINE);
        capacity = n;
    }

    T* data() { return values; }
    const T* data() const { return values; }

private:
    struct Free
    {
        void operator()(void* p) const { fastFree(p); }
    };

    std::unique_ptr<void, Free> memory;
    T* values;
    size_t capacity;
};

//! Memory that a thread reuses for values of any type. Each use loses the content.
class ScratchMemory
{
public:
    //! Room for n values on a cache line, not initialized.
    template <typename T> T* get(size_t n)
    {
        bytes.allocate(n * sizeof(T));
        return reinterpret_cast<T*>(bytes.data());
    }

private:
    AlignedBuffer<uchar> bytes;
};

/** Rows of an image for kernels: each begins on a cache line, with room for reach + ROW_PADDING values on either side.
With fewer rows than the image has, they are a ring: row y replaces row y - size.height. */
template <typename T> class PaddedRows
{
public:
    //! Not initialized, or zeros.
    explicit PaddedRows(Size size_, int reach = 0, bool zeros = false)
        : size(size_), padding(wholeLines<T>(reach + ROW_PADDING)),
          step(wholeLines<T>(size_.width + 1) + 2 * padding),
          reciprocal(((uint64)1 << 32) / std::max(size_.height, 1) + 1), values(step * size_.height)
    {
        if (zeros)
            std::fill_n(values.data(), step * size.height, T());
    }

    T* row(int y) { return values.data() + place(y) * step + padding; }
    const T* row(int y) const { return values.data() + place(y) * step + padding; }

    //! Repeats the ends of a row of `width` values.
    void repeatEnds(int y, int width, int times = 1)
    {
        const int together = 8;  // more than that does no harm
        T* const r = row(y);
        for (int i = 0; i < times; i += together)
        {
            std::fill_n(r - i - together, together, r[0]);
            std::fill_n(r + width + i, together, r[width - 1]);
        }
    }

    Size size;

private:
    //! y modulo size.height without a division: exact while their product is below 2^32.
    int place(int y) const { return y < size.height ? y : y - size.height * (int)(y * reciprocal >> 32); }

    size_t padding, step;
    uint64 reciprocal;
    AlignedBuffer<T> values;
};

}}  // namespace cv::iib
