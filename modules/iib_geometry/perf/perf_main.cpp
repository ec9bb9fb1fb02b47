// SPDX-License-Identifier: Apache-2.0
#include "perf_precomp.hpp"

CV_PERF_TEST_MAIN(iib_geometry)
