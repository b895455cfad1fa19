// SPDX-License-Identifier: GPL-3.0-or-later
// What vam-score writes beside its figures: the print, where light can come from, a table of several doses.
#pragma once

#include <string>
#include <vector>

#include "cli/app.hpp"
#include "io/vdb/vdb.hpp"
#include "model/grid.hpp"
#include "model/printer.hpp"
#include "vam-score/options.hpp"

namespace vam::score_tool {

/// To --mesh. Throws Fault::data when nothing prints at this dose.
void write_print(const Options& options, const io::SparseVolume& dose, double threshold);

/// Writes the grid 'lit_fraction' over those voxels: the fraction of stage angles [0, 1] from which the projector
/// lights each (optics::lit_fraction); 0 outside the resin. The line of `app` is its history.
void write_lit_fraction(const std::string& path, const model::Grid& grid, const model::Printer& printer,
                        const cli::App& app);

/// Rows of as many cells each, of which the first is the heading, as csv, markdown or latex (a tabular).
using Table = std::vector<std::vector<std::string>>;
[[nodiscard]] std::string text_of(const Table& table, const std::string& form);

}  // namespace vam::score_tool
