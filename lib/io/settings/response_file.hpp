// SPDX-License-Identifier: GPL-3.0-or-later
// The projector's response table: CSV with the header "grey,intensity".
#pragma once

#include <string>
#include <vector>

#include "model/response_table.hpp"

namespace vam::io {

/// Reads two comma-separated columns; lines that are empty or begin with # are skipped, a first line of words is the
/// header. Intensity in any unit: the last line is full grey. Warns where that is below 2^bits - 1. Throws Error:
/// no_input, data (with file and line: not two numbers, grey not rising from 0, negative, falling or absurd intensity,
/// fewer than two lines, greys above 2^bits - 1).
[[nodiscard]] model::ResponseTable read_response(const std::string& file, int bits);

}  // namespace vam::io
