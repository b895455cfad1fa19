// SPDX-License-Identifier: GPL-3.0-or-later
// Arrays, images and videos as a stack of sinograms.
#pragma once

#include <optional>

#include "io/stream/file_type.hpp"
#include "vam-convert/options.hpp"

namespace vam::convert_tool {

/// `type`: what the input is, if it is no array. Frames that state printer and exposure keep both. Throws Error: usage
/// (a step that does not divide a turn, another pixel than the projector's), data (less than a turn, light beside the
/// projector's columns).
void make_projections(const cli::App& app, Options options, std::optional<io::FileType> type);

}  // namespace vam::convert_tool
