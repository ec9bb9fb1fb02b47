// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "opencv2/core.hpp"
#include "opencv2/core/utility.hpp"
#include "opencv2/iib_index.hpp"
