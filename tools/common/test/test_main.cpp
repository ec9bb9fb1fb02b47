// SPDX-License-Identifier: Apache-2.0

#include "opencv2/ts.hpp"

CV_TEST_MAIN("")
