// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#ifndef OPENCV_IIB_INDEX_TEST_FAILING_ALLOCATION_HPP
#define OPENCV_IIB_INDEX_TEST_FAILING_ALLOCATION_HPP

namespace opencv_test {

//! The allocation by `new` after `count` others of this thread fails, while the object lives. Linux alone.
struct FailingAllocation
{
    explicit FailingAllocation(long count);
    ~FailingAllocation();
    static bool happened();
};

}  // namespace opencv_test

#endif
