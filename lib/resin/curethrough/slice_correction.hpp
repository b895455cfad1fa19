// SPDX-License-Identifier: GPL-3.0-or-later
// Corrected slices of a whole part, one after the other, in memory for one slice beside the part's bits [CURE19].
#pragma once

#include <span>
#include <vector>

#include "base/image.hpp"
#include "resin/curethrough/part_columns.hpp"
#include "resin/curethrough/target_dose.hpp"

namespace vam::resin {

/// Where every pixel column is with respect to its features, while a caller steps from node to node.
class ColumnCursor {
 public:
  ColumnCursor(const PartColumns& part, const TargetDose& dose);

  /// Places the columns of row y, or moves them to `node` by one step from where they were, down being towards the
  /// window.
  void place(int y, int node);
  void step(int y, int node, bool down);

  [[nodiscard]] const int* below(int y) const { return below_.data() + start(y); }
  [[nodiscard]] const int* above(int y) const { return above_.data() + start(y); }

 private:
  [[nodiscard]] std::size_t start(int y) const { return static_cast<std::size_t>(y) * part_.width(); }
  void place_column(std::size_t column, int node);
  const PartColumns& part_;
  const TargetDose& dose_;
  std::vector<int> below_;
  std::vector<int> above_;
  std::vector<int> first_;  // of the run that holds the node
  std::vector<int> last_;
};

/// Throws Fault::data when the light is too weak to cure at this speed (settled(phi_max) <= 1) or the dark is bright
/// enough to cure (settled(phi_min) >= 1): then no column with a feature has a solution.
void require_printable(const CureLimits& limits);

/// The exact correction in printing order: slice 0 first. Intensities are fractions of the maximum, as floats.
class SliceCorrection {
 public:
  /// `part` must outlive this. slices = the part's own and the extra ones.
  SliceCorrection(const PartColumns& part, const CureLimits& limits, const DoseLimit& limit, int slices);
  [[nodiscard]] int slices() const { return dose_.slices(); }
  /// Intensity / maximum intensity of the next slice, in [phi_min / phi_max, 1].
  void next(Image& slice);

 private:
  const PartColumns& part_;
  CureLimits limits_;
  TargetDose dose_;
  ColumnCursor cursor_;
  std::vector<double> omega_;
  int done_ = 0;
};

/// The correction in grey levels, last slice first. Each level is the lowest whose light reaches the target dose given
/// the levels already chosen further down, so rounding does not add up: inside features Omega >= 1 always, and it stays
/// within gain * (step of the levels) of the exact solution, where rounding every slice by itself would settle half a
/// level away from it.
class LevelCorrection {
 public:
  /// levels[v] = intensity of grey level v as a fraction of the maximum, rising; the first is phi_min / phi_max, the
  /// last 1. Throws Fault::data when they fall anywhere or there are more than 65536.
  LevelCorrection(const PartColumns& part, const CureLimits& limits, const DoseLimit& limit, int slices,
                  std::span<const float> levels);
  [[nodiscard]] int slices() const { return dose_.slices(); }
  /// Grey levels of the slice before the one given last, row-major; begins with slice slices() - 1.
  void previous(std::vector<std::uint16_t>& slice);

 private:
  const PartColumns& part_;
  CureLimits limits_;
  TargetDose dose_;
  ColumnCursor cursor_;
  std::vector<double> phi_;  // of each level
  std::vector<double> omega_;
  int left_;
};

}  // namespace vam::resin
