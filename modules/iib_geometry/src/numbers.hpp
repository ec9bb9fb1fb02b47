// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <charconv>
#include <cmath>
#include <string>
#include <vector>

namespace iib_localization {

//! The finite numbers that a text holds, separated by commas; none if it holds anything else.
inline std::vector<double> numbersOf(const std::string& text)
{
    std::vector<double> values;
    for (const char *at = text.data(), *last = at + text.size();; at++)
    {
        double value = 0;
        const auto [end, error] = std::from_chars(at, last, value);
        if (error != std::errc() || !std::isfinite(value) || (end != last && *end != ','))
            return {};
        values.push_back(value);
        if (end == last)
            return values;
        at = end;
    }
}

//! The shortest decimal that reads back as the same number.
inline std::string shortest(double value)
{
    char text[32];
    return std::string(text, std::to_chars(text, text + sizeof(text), value).ptr);
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

}  // namespace iib_localization
