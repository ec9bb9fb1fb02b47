// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#ifndef OPENCV_IIB_INDEX_TEST_FAILING_ALLOCATION_HPP
#define OPENCV_IIB_INDEX_TEST_FAILING_ALLOCATION_HPP

// Sanitizers of addresses and threads have allocators of their own, which must see both ends of each allocation.
#if defined __linux__ && !defined __SANITIZE_ADDRESS__ && !defined __SANITIZE_THREAD__
#define IIB_ALLOCATIONS_CAN_FAIL
#endif

namespace opencv_test {

//! The allocation by `new` after `count` others of this thread fails, while the object lives. Where IIB_ALLOCATIONS_CAN_FAIL
//! is defined.
struct FailingAllocation
{
    explicit FailingAllocation(long count);
    ~FailingAllocation();
    static bool happened();
};

}  // namespace opencv_test

#endif
