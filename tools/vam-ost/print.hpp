// SPDX-License-Identifier: GPL-3.0-or-later
// What of a scattering volume is the print: where it reaches the isovalue, without what is not of it.
#pragma once

#include <optional>

#include "base/text/json.hpp"
#include "cli/app.hpp"
#include "metrology/cure/bodies.hpp"
#include "metrology/cure/cured.hpp"
#include "metrology/ost/surface_uncertainty.hpp"
#include "model/grid.hpp"
#include "model/printer.hpp"
#include "vam-ost/options.hpp"

namespace vam::ost_tool {

class Print {
 public:
  /// Reads the record of the isovalue and the target.
  Print(const cli::App& app, const Options& options, const model::PrinterCamera& camera);

  /// Throws Fault::data when --mesh is wanted and no voxel reaches the isovalue.
  void require_in(const model::Volume& volume) const;
  /// With an isovalue: drops the bodies that are not the print, for all that follows. Says what was dropped.
  void keep(model::Volume& volume);
  /// Throws Fault::data when --mesh is wanted and keep() has dropped every body.
  void require_kept() const;
  /// --mesh, with the uncertainty of its vertices where that of the voxels is known, and --projections.
  void write(const model::Volume& volume, const metrology::VoxelUncertainty* sigma = nullptr) const;
  /// What the last call of keep() kept and dropped; nothing without an isovalue.
  [[nodiscard]] std::optional<metrology::BodyCount> bodies() const;
  /// Nothing without isovalue and target.
  [[nodiscard]] std::optional<metrology::Cured> state(const model::Volume& volume) const;
  /// isovalue, bodies and print, of a report; empty without an isovalue.
  [[nodiscard]] Json figures(const model::Volume& volume) const;

 private:
  const cli::App& app_;
  const Options& options_;
  bool absorbs_;
  std::optional<double> isovalue_;
  metrology::BodyRules rules_;
  std::optional<model::StretchedVolume> target_;
  metrology::BodyCount bodies_;
  std::vector<std::string> cut_;  // metrology::cut_sides
};

}  // namespace vam::ost_tool
