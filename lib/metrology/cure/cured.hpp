// SPDX-License-Identifier: GPL-3.0-or-later
// The print as it stands: overhead projections of the scattering volume, and how much of the design is there.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/image.hpp"
#include "base/text/json_fwd.hpp"
#include "model/grid.hpp"
#include "model/value_at.hpp"

namespace vam::metrology {

/// Sums along the light's three directions, in value x mm: x and y give side views (columns along y or x, z upwards),
/// z the overhead view (columns along x, y upwards) [OST22 figs 4, 5]. With a threshold each voxel counts 1 or 0.
struct SumProjections {
  Image along_x;
  Image along_y;
  Image along_z;
};
[[nodiscard]] SumProjections sum_projections(const model::Volume& volume, std::optional<double> threshold = {});

/// Volumes in mm^3, of what is cured ({scatter >= I_p}) against a target (coverage of 1/2 or more).
struct Cured {
  double target_mm3 = 0;
  double cured_mm3 = 0;
  double missing_mm3 = 0;   // in the target, not cured
  double overcure_mm3 = 0;  // cured, not in the target
  double iou = 0;           // of the two
  /// Relative to the target as sampled by the print's voxels, which are not the target's: 100 before anything is cured.
  [[nodiscard]] double missing_percent() const { return 100 * missing_mm3 / (missing_mm3 + cured_mm3 - overcure_mm3); }
  [[nodiscard]] double overcure_percent() const { return 100 * overcure_mm3 / target_mm3; }
};

/// The target lies in the frame of the print, on any grid. Throws Fault::data when it is empty.
[[nodiscard]] Cured cured(const model::Volume& scatter, double level, const model::StretchedVolume& target);

[[nodiscard]] Json to_json(const Cured& state);

/// The names and values that --until knows: missing and overcure in per cent, iou, cured in mm^3.
[[nodiscard]] const std::vector<std::string>& cured_names();
[[nodiscard]] double figure(const Cured& state, const std::string& name);

}  // namespace vam::metrology
