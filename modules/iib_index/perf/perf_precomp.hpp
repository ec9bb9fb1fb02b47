// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "opencv2/iib_index.hpp"
#include "opencv2/core/utils/filesystem.hpp"
#include "opencv2/ts.hpp"
