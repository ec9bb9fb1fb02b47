// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace iib_localization {

//! The SHA-256 of a file (FIPS 180-4) in hexadecimal digits; empty if it cannot be read.
std::string sha256OfFile(const std::string& path);

}  // namespace iib_localization
