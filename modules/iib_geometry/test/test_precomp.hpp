// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "opencv2/iib.hpp"
#include "opencv2/iib_geometry.hpp"
#include "opencv2/ts.hpp"
#include "../src/precomp.hpp"
