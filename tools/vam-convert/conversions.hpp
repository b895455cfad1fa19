// SPDX-License-Identifier: GPL-3.0-or-later
// What vam-convert does, a file each.
#pragma once

#include <optional>

#include "io/stream/file_type.hpp"
#include "model/printer.hpp"
#include "vam-convert/options.hpp"

namespace vam::convert_tool {

/// Volumes as arrays of NumPy: [z][y][x], a few slices at a time.
void export_volume(const Options& options);
/// Stacks, too: [image][row][column], an image at a time.
void export_stack(const Options& options);

/// Arrays and images as a volume. `type`: what the input is, if it is no array. Throws Fault::data.
void make_volume(const cli::App& app, const Options& options, std::optional<io::FileType> type,
                 const model::Printer& printer);
/// Arrays, images and videos as a stack of sinograms; frames that state printer and exposure keep both. Throws Error:
/// usage (another pixel than the projector's), data (less than a turn, light beside the projector's columns).
void make_projections(const cli::App& app, Options options, std::optional<io::FileType> type);

/// The commands cut and join, of pieces of a stack that make the bytes of the undivided one. What they run throws
/// Error: usage, no_input, data (no pieces of one stack, or not all of it that are asked for), no_output.
void add_pieces(cli::App& app);

}  // namespace vam::convert_tool
