// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <charconv>
#include <cmath>
#include <string>

namespace iib_localization {

//! Reads the whole text as a finite number.
inline bool readNumber(const std::string& text, double& value)
{
    const char* const last = text.data() + text.size();
    const auto [end, error] = std::from_chars(text.data(), last, value);
    return error == std::errc() && end == last && std::isfinite(value);
}

//! The shortest decimal that reads back as the same number.
inline std::string shortest(double value)
{
    char text[32];
    return std::string(text, std::to_chars(text, text + sizeof(text), value).ptr);
}

}  // namespace iib_localization
