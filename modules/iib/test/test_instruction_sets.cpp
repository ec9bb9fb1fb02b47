// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#include "test_precomp.hpp"
#include "../src/descriptor/kernels/kernels.hpp"
#include "../src/matcher/kernels/hamming.hpp"

namespace opencv_test {
namespace {

//! Of those that the library has kernels for and OPENCV_CPU_DISABLE leaves.
String widestInstructionSet()
{
    if (!checkHardwareSupport(CPU_SSE4_2) || !checkHardwareSupport(CPU_POPCNT))
        return "baseline";
    if (!checkHardwareSupport(CPU_AVX2) || !checkHardwareSupport(CPU_FMA3))
        return "SSE4_2";
    if (!checkHardwareSupport(CPU_AVX512_SKX))
        return "AVX2";
    return checkHardwareSupport(CPU_AVX512_ICL) ? "AVX512_ICL" : "AVX512_SKX";
}

#if defined(__x86_64__) || defined(_M_X64)
TEST(IIB_InstructionSets, descriptor_runs_on_the_widest)
{
    EXPECT_EQ(widestInstructionSet(), descriptorKernels().instructionSet);
}

TEST(IIB_InstructionSets, matcher_runs_on_the_widest)
{
    EXPECT_EQ(widestInstructionSet(), hammingKernels().instructionSet);
}
#endif

// What the environment took away must be gone: else the runs of all suites under pins would repeat the same kernels.
TEST(IIB_InstructionSets, pins_work)
{
    const char* const disabled = getenv("OPENCV_CPU_DISABLE");
    if (!disabled)
        return;
    const std::pair<const char*, int> sets[] = {{"AVX512-ICL", CPU_AVX512_ICL},
            {"AVX512-SKX", CPU_AVX512_SKX}, {"AVX2", CPU_AVX2}, {"SSE4.2", CPU_SSE4_2}};
    for (const auto& set : sets)
    {
        const bool pinned = String(disabled).find(set.first) != String::npos;
        EXPECT_FALSE(pinned && checkHardwareSupport(set.second)) << set.first;
    }
}

}  // namespace
}  // namespace opencv_test
