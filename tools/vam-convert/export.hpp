// SPDX-License-Identifier: GPL-3.0-or-later
// Volumes and stacks as arrays of NumPy.
#pragma once

#include "vam-convert/options.hpp"

namespace vam::convert_tool {

/// [z][y][x], a few slices at a time.
void export_volume(const Options& options);
/// [image][row][column], an image at a time.
void export_stack(const Options& options);

}  // namespace vam::convert_tool
