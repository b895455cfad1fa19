// SPDX-License-Identifier: GPL-3.0-or-later
// Sections of volumes, and a dose judged against its target.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "io/vdb/gate.hpp"
#include "io/vdb/vdb.hpp"
#include "model/printer.hpp"
#include "score/score.hpp"
#include "session/volumes.hpp"

namespace vam::report_tool {

/// All grids of the report's files. The first target and the first dose are the ones that are judged.
struct Volumes {
  std::vector<std::string> files;  // of each grid
  std::vector<io::SparseVolume> grids;
  [[nodiscard]] const io::SparseVolume* find(const std::string& name) const { return session::find_grid(grids, name); }
};

/// Target and insert take the dose's grid, with void around. Throws what read_volumes throws; Fault::data where the
/// voxels of target and dose lie elsewhere.
[[nodiscard]] Volumes read_volumes(const std::vector<std::string>& paths, io::TargetKind kind);

/// HTML: axial and coronal sections of every grid, the dose with the target's outline if `outlined` and the critical
/// dose on its colour bar where it is known, both with the insert.
[[nodiscard]] std::string section_views(const Volumes& volumes, int count, bool outlined,
                                        std::optional<double> critical);

/// HTML: axial sections of what the dose cures at the threshold, and of what is missing; both must be there.
[[nodiscard]] std::string cure_views(const Volumes& volumes, const score::ScoreOptions& how, double threshold,
                                     int count);

/// HTML: the shares of part and void over the dose; both must be there.
[[nodiscard]] std::string histogram(const Volumes& volumes, const score::ScoreOptions& how);

}  // namespace vam::report_tool
