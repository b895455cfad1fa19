// SPDX-License-Identifier: GPL-3.0-or-later
// The grid of the dose.
#pragma once

#include <vector>

#include "io/vdb/vdb.hpp"
#include "model/grid.hpp"
#include "model/printer.hpp"
#include "model/stack.hpp"
#include "vam-dose/options.hpp"

namespace vam::dose_tool {

/// The voxels, what is known about them, and the part and the insert if there are any.
struct Place {
  std::vector<io::SparseVolume> grids;
  const io::SparseVolume* like = nullptr;  // of these the target, or else the first
  const io::SparseVolume* target = nullptr;
  const io::SparseVolume* insert = nullptr;
  model::Grid grid;
  double judged_mm = 0;  // radius of the resin that is judged
};

/// The stack with the poses to judge it by: --poses, or its own. Throws Fault::usage where they do not apply,
/// Fault::data where they are not one a frame.
[[nodiscard]] model::StackInfo posed(const cli::App& app, model::StackInfo info, const Options& options);

/// The grid of --like, or one around what the light reaches. Throws Fault::data when an exposure is to be planned
/// without part.
[[nodiscard]] Place place_of(const Options& options, const model::Printer& printer, const model::StackInfo& info);

/// The volume 'dose', with the histories of light and part.
[[nodiscard]] io::SparseVolume empty_volume(const cli::App& app, const Place& place, const model::Printer& printer,
                                            const model::StackInfo& info, const Options& options);

}  // namespace vam::dose_tool
