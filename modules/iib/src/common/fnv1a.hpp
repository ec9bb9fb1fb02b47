// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#pragma once

#include "opencv2/core.hpp"

namespace cv {
namespace iib {

//! The 64-bit FNV-1a hash of a sequence of bytes.
class Fnv1a
{
public:
    Fnv1a() : state(CV_BIG_UINT(0xcbf29ce484222325)) {}
    void add(const void* data, size_t size)
    {
        for (size_t i = 0; i < size; i++)
            state = (state ^ static_cast<const uchar*>(data)[i]) * CV_BIG_UINT(0x100000001b3);
    }
    uint64 value() const { return state; }

private:
    uint64 state;
};

}  // namespace iib
}  // namespace cv
