// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <locale>
#include <sstream>
#include <string>
#include <vector>

namespace cv::iib {

//! The finite numbers that a text holds, separated by commas; none if it holds anything else.
inline std::vector<double> numbersOf(const std::string& text)
{
    std::istringstream stream(text);  // no std::from_chars: before macOS 26 it reads no numbers with a point
    stream.imbue(std::locale::classic());
    std::vector<double> values;
    do
    {
        double value = 0;
        if (!(stream >> std::noskipws >> value) || !std::isfinite(value))
            return {};
        values.push_back(value);
    } while (stream.get() == ',');
    return stream.eof() ? values : std::vector<double>();
}

//! The decimal of the fewest digits, 15 at least but for zeros, that reads back as the same number.
inline std::string shortest(double value)
{
    for (int digits = 15;; digits++)
    {
        std::ostringstream text;
        text.imbue(std::locale::classic());
        text << std::setprecision(digits) << value;
        if (digits == 17 || numbersOf(text.str()) == std::vector<double>(1, value))
            return text.str();
    }
}

//! Of one number or more; of none, 0.
inline double median(std::vector<double> values)
{
    if (values.empty())
        return 0;
    const auto middle = values.begin() + std::ptrdiff_t(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

}  // namespace cv::iib
