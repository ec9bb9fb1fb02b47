// SPDX-License-Identifier: Apache-2.0

#include "failing_allocation.hpp"

// In a file of its own: where one of the operators is inlined and the other is not, compilers warn that they do not match.
#ifdef IIB_ALLOCATIONS_CAN_FAIL
#include <cstdlib>
#include <new>

namespace {
thread_local long untilFailure = -1;  // < 0: none fails
}

// The dynamic linker prefers these to those of the libraries.
void* operator new(std::size_t size)
{
    void* const memory = untilFailure >= 0 && untilFailure-- == 0 ? 0 : std::malloc(size + (size == 0));
    if (!memory)
        throw std::bad_alloc();
    return memory;
}
void operator delete(void* memory) noexcept { std::free(memory); }

namespace opencv_test {

FailingAllocation::FailingAllocation(long count) { untilFailure = count; }
FailingAllocation::~FailingAllocation() { untilFailure = -1; }
bool FailingAllocation::happened() { return untilFailure < 0; }

}  // namespace opencv_test
#endif
