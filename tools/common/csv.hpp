// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

namespace iib_tools {

//! The fields of a line between its commas, which nothing quotes; a carriage return at its end is no part of them.
inline std::vector<std::string> splitFields(const std::string& line)
{
    std::vector<std::string> fields(1);
    for (char c : line.substr(0, line.find_last_not_of('\r') + 1))
        if (c == ',')
            fields.push_back("");
        else
            fields.back() += c;
    return fields;
}

}  // namespace iib_tools
