// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#pragma once

#include "opencv2/core.hpp"
#include "opencv2/core/utility.hpp"
#include "opencv2/iib.hpp"
