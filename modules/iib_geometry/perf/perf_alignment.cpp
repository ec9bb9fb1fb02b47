// SPDX-License-Identifier: Apache-2.0
#include "perf_precomp.hpp"

namespace opencv_test { namespace {

typedef perf::TestBaseWithParam<int> IIB_Align;  // megapixels

//! Pictures enlarged, in colour as photographs are.
PERF_TEST_P(IIB_Align, noon_and_winter, testing::Values(2, 12, 50))
{
    Mat images[] = {picture("street_noon"), picture("street_winter")};
    for (Mat& image : images)
    {
        const double scale = std::sqrt(GetParam() * 1e6 / double(image.total()));
        resize(image, image, Size(), scale, scale, INTER_CUBIC);
        cvtColor(image, image, COLOR_GRAY2BGR);
    }
    Mat transform;
    const Threads one(1);
    TEST_CYCLE() ASSERT_TRUE(alignImages(images[0], images[1], transform));
    SANITY_CHECK_NOTHING();
}

}}  // namespace opencv_test
