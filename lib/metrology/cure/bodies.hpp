// SPDX-License-Identifier: GPL-3.0-or-later
// The print as a body: connected components at the gelation threshold, and which are noise, bubbles or dirt.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "base/text/json_fwd.hpp"
#include "model/grid.hpp"
#include "model/value_at.hpp"

namespace vam::metrology {

/// A box in mm; bodies wholly outside it are dropped.
struct Neighbourhood {
  std::array<double, 3> low{};
  std::array<double, 3> high{};
};

/// The box around all voxels of a target that are covered by a half or more, grown by margin_mm on all sides.
/// Throws Fault::data when there is none.
[[nodiscard]] Neighbourhood neighbourhood(const model::StretchedVolume& target, double margin_mm);

struct BodyRules {
  std::optional<double> least_mm3;      // smallest body that is kept; 1 % of the largest by default
  std::optional<Neighbourhood> inside;  // none: the whole volume
};

/// Bodies that were kept and dropped.
struct BodyCount {
  int kept = 0;
  int dropped = 0;         // bodies too small or elsewhere
  double kept_mm3 = 0;     // of all kept bodies
  double dropped_mm3 = 0;  // of all dropped bodies
  double largest_dropped_mm3 = 0;
  int filled = 0;     // cavities below resolution, 27 voxels
  double inside = 0;  // median of the values above half the level
};

/// Lowers the voxels of dropped bodies of { volume >= level } to 0 and raises those of cavities smaller than a cube of
/// three voxels to the level. Bodies touch by faces, edges or corners, cavities by faces [physics §8].
BodyCount keep_bodies(model::Volume& volume, double level, const BodyRules& rules);

[[nodiscard]] Json to_json(const BodyCount& count);

/// Sides on which { volume >= level } reaches the end of the camera's view, so that its surface there is a cut: any of
/// "top", "bottom" and "side".
[[nodiscard]] std::vector<std::string> cut_sides(const model::Volume& volume, double level);

}  // namespace vam::metrology
