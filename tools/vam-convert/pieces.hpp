// SPDX-License-Identifier: GPL-3.0-or-later
// Pieces of a stack of images: cut out, and joined to the bytes of the undivided stack.
#pragma once

#include <string>
#include <vector>

#include "cli/app.hpp"
#include "io/exr/stack.hpp"

namespace vam::convert_tool {

struct PieceOptions {
  std::vector<std::string> inputs{"-"};
  std::string slices;  // to cut; empty: all are joined
  std::string output = "-";
  io::StackOptions stack;
};

/// Declares the commands cut and join.
void declare_pieces(cli::App& app, PieceOptions& options, std::string& command);

/// Throws Error: usage, no_input, data (no pieces of one stack, or not all of it that are asked for), no_output.
void copy_pieces(const PieceOptions& options);

}  // namespace vam::convert_tool
