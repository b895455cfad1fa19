// SPDX-License-Identifier: GPL-3.0-or-later
// Where light can come from: the map of --lit-fraction.
#pragma once

#include <string>

#include "cli/app.hpp"
#include "model/grid.hpp"
#include "model/printer.hpp"

namespace vam::score_tool {

/// Writes the grid 'lit_fraction' over those voxels: the fraction of stage angles [0, 1] from which the projector
/// lights each (optics::lit_fraction); 0 outside the resin. The line of `app` is its history.
void write_lit_fraction(const std::string& path, const model::Grid& grid, const model::Printer& printer,
                        const cli::App& app);

}  // namespace vam::score_tool
