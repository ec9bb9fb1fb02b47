// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

// Tile compares some queries with a CodeBlock, TileQueries prepares these queries, PACKING is the packing that both
// understand: by tables in registers where bytes are looked up faster than the bits of words are counted, else by adders.

#ifndef OPENCV_IIB_MATCHER_KERNELS_TILE_SIMD_HPP
#define OPENCV_IIB_MATCHER_KERNELS_TILE_SIMD_HPP

#include "../../common/simd.hpp"

#if IIB_LOOKS_UP_16 && !IIB_COUNTS_LANES
#include "tile_tables.simd.hpp"
#else
#include "tile_adders.simd.hpp"
#endif

#endif
