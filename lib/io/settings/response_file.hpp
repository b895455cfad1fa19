// SPDX-License-Identifier: GPL-3.0-or-later
// The projector's response table: CSV with the header "grey,intensity".
#pragma once

#include <string>
#include <vector>

#include "model/response_table.hpp"

namespace vam::io {

/// Reads two comma-separated columns; lines that are empty or begin with # are skipped, a first line of words is the
/// header. Any units: the last line is full grey. Throws Error: no_input, data (with file and line: not two numbers,
/// grey not rising from 0, negative or falling intensity, fewer than two lines).
[[nodiscard]] model::ResponseTable read_response(const std::string& file);

}  // namespace vam::io
