// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "opencv2/core.hpp"

//! The bytes of a .npy file as NumPy writes it; CV_32F or CV_8U.
inline std::string npyText(const cv::Mat& array, int version = 1)
{
    std::string header = cv::format("{'descr': '%s', 'fortran_order': False, 'shape': (%d, %d), }",
            array.type() == CV_32F ? "<f4" : "|u1", array.rows, array.cols);
    const size_t before = version == 1 ? 10 : 12;
    header += std::string(63 - (header.size() + before) % 64, ' ') + "\n";
    std::string text = "\x93NUMPY" + std::string(1, char(version)) + '\0';
    for (size_t i = 0; i < before - 8; i++)
        text += char(header.size() >> 8 * i);
    return text + header + std::string(array.ptr<char>(), array.total() * array.elemSize());
}
