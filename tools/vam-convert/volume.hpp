// SPDX-License-Identifier: GPL-3.0-or-later
// Arrays as volumes.
#pragma once

#include <optional>

#include "io/stream/file_type.hpp"
#include "model/printer.hpp"
#include "vam-convert/options.hpp"

namespace vam::convert_tool {

/// `type`: what the input is, if it is no array. Throws Error: usage (frames and video are no volume), data.
void make_volume(const cli::App& app, const Options& options, std::optional<io::FileType> type,
                 const model::Printer& printer);

}  // namespace vam::convert_tool
