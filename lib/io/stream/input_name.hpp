// SPDX-License-Identifier: GPL-3.0-or-later
// What messages call an input.
#pragma once

#include <string>

namespace vam::io {

/// The path, or "stdin" for "-".
[[nodiscard]] inline std::string input_name(const std::string& path) { return path == "-" ? "stdin" : path; }

}  // namespace vam::io
