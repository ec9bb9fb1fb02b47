// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#include "test_precomp.hpp"
#include "../src/descriptor/kernels/kernels.hpp"
#include "../src/matcher/kernels/hamming.hpp"
#include "support/describe.hpp"

// Compilers free the upper halves where they optimize for speed, and that is when it counts: not in sanitized builds
// (-O1).
#if defined(__x86_64__) && defined(__GNUC__) && defined(NDEBUG) && !defined(__OPTIMIZE_SIZE__)
#define IIB_UPPER_HALVES_ARE_FREED
#include <cpuid.h>
#include <immintrin.h>
#endif

namespace opencv_test { namespace {

#if defined(__x86_64__) || defined(_M_X64)
//! The widest one with kernels that OPENCV_CPU_DISABLE allows.
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

TEST(IIB_InstructionSets, the_widest_is_used)
{
    EXPECT_EQ(widestInstructionSet(), descriptorKernels().instructionSet);
    EXPECT_EQ(widestInstructionSet(), hammingKernels().instructionSet);
}

// Byte lookups are faster, up to twice, unless one instruction counts the bits of a vector.
TEST(IIB_InstructionSets, tables_from_SSE4_2_up_to_AVX512_SKX)
{
    const String set = hammingKernels().instructionSet;
    const CodePacking expected = set == "baseline" || set == "AVX512_ICL" ? PACKING_ADDERS : PACKING_TABLES;
    EXPECT_EQ(expected, hammingKernels().packing);
}
#endif

#ifdef IIB_UPPER_HALVES_ARE_FREED
//! Whether the processor reports which parts of registers are in use.
bool tellsWhatIsInUse()
{
    unsigned a, b, c, d;
    if (!__get_cpuid(1, &a, &b, &c, &d) || !(c & bit_OSXSAVE))
        return false;
    return __get_cpuid_count(0xd, 1, &a, &b, &c, &d) && (a & 4);
}

//! The upper halves of ymm0 to ymm15 and of zmm0 to zmm15.
__attribute__((target("xsave"))) unsigned upperHalvesInUse() { return (unsigned)_xgetbv(1) & 0x44; }

// Dirty upper halves slow down all code without AVX that follows.
TEST(IIB_InstructionSets, calls_leave_no_upper_halves_in_use)
{
    if (!tellsWhatIsInUse())
        throw SkipTestException("the processor does not report which parts of its registers are in use");
    const Mat image = texture(Size(160, 120), CV_8U, 1);
    std::vector<KeyPoint> keypoints = {KeyPoint(60, 60, 20), KeyPoint(80, 50, 20, 30)};
    Mat descriptors;
    for (int preset = 0; preset <= IIB::PRESET_SMALL; preset++)
        for (int orientation : {IIB::ORIENTATION_NONE, IIB::ORIENTATION_KEYPOINT, IIB::ORIENTATION_GRADIENT})
        {
            const Ptr<IIB> iib = IIB::createPreset(preset);
            iib->setOrientation(orientation);
            iib->compute(image, keypoints, descriptors);
            EXPECT_EQ(0u, upperHalvesInUse()) << "preset " << preset << ", orientation " << orientation;
            std::vector<DMatch> matches;
            HierarchicalMatcher::create(iib->levelSizes())->match(descriptors, descriptors, matches);
            EXPECT_EQ(0u, upperHalvesInUse()) << "matching, preset " << preset;
        }
}
#endif

// If pins did not work, runs under pins would all test the same kernels.
TEST(IIB_InstructionSets, pins_work)
{
    const char* pin = getenv("OPENCV_CPU_DISABLE");
    std::stringstream names(pin ? pin : "");
    String name;
    while (std::getline(names, name, ','))
    {
        bool known = false;
        for (int feature = 1; feature < CV_HARDWARE_MAX_FEATURE; feature++)
            if (getHardwareFeatureName(feature) == name)
            {
                known = true;
                EXPECT_FALSE(checkHardwareSupport(feature)) << name;
            }
        EXPECT_TRUE(known) << "OPENCV_CPU_DISABLE: " << name;
    }
}

}}  // namespace opencv_test
