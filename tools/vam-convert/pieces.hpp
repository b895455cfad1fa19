// SPDX-License-Identifier: GPL-3.0-or-later
// Pieces of a stack of images: cut out, and joined to the bytes of the undivided stack.
#pragma once

#include "cli/app.hpp"

namespace vam::convert_tool {

/// The commands cut and join. What they run throws Error: usage, no_input, data (no pieces of one stack, or not all of
/// it that are asked for), no_output.
void add_pieces(cli::App& app);

}  // namespace vam::convert_tool
