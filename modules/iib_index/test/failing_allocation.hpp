// SPDX-License-Identifier: Apache-2.0
#pragma once

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
