// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#include "../support/test_errors.hpp"
#include "../../src/matcher/knn_table.hpp"

namespace opencv_test {
namespace {

TEST(IIB_KnnTable, what_memory_cannot_hold_is_an_error_that_names_k)
{
    expectError(Error::StsNoMem, format("k is %d", INT_MAX), [] { KnnTable(INT_MAX, INT_MAX); });
    expectError(
            Error::StsNoMem, format("k is %d", INT_MAX), [] { forNeighbours<int64>(INT_MAX, INT_MAX, -1); });
}

}  // namespace
}  // namespace opencv_test
