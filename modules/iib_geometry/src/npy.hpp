// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "opencv2/core.hpp"

namespace iib_localization {

//! CRC-32 of ISO 3309, as zlib has it; `sum` is that of the bytes before.
uint32_t crc32(const void* data, size_t size, uint32_t sum = 0);

/** An array of one or two dimensions of NumPy's `.npy` format, version 1, in C order.
@param type CV_8U, CV_32S or CV_64F: that of the array.
@param checksum CRC-32 of the file, in eight hexadecimal digits.
@throws cv::Exception with the file's name for anything else. */
cv::Mat readNpy(const std::string& file, int type, const std::string& checksum);

}  // namespace iib_localization
