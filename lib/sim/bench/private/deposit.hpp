// SPDX-License-Identifier: GPL-3.0-or-later
// The projector's light in the voxels of a simulated print: rays that climb leave there what is absorbed.
#pragma once

#include <vector>

#include "base/pixels.hpp"
#include "model/grid.hpp"
#include "model/printer.hpp"
#include "sim/bench/private/ray.hpp"

namespace vam::sim {

/// Rays a little more than half a voxel apart, from the lens to where they enter the resin, all traced once.
class Deposit {
 public:
  /// sigma_mm: standard deviation of the beam's blur.
  Deposit(const model::Printer& printer, const model::Grid& grid, double gamma, double sigma_mm);

  /// The light of `image` for `seconds`, on a part at that angle, added in mJ/cm3. The vial stands right_px columns of
  /// the projector to the right of projector.axis_column; full grey is `full_mw_cm2`.
  void add(const GreyImage& image, double part_rad, double right_px, double full_mw_cm2, double seconds,
           std::vector<float>& absorbed) const;

 private:
  struct Row {
    double top_mm, bottom_mm;
    std::vector<ClimbingRay> rays;
  };
  void leave(const ClimbingRay& ray, double phase, double dose, std::vector<float>& absorbed) const;

  const model::Projector projector_;
  model::Grid grid_;
  double absorption_per_mm_;
  double gamma_;
  double sigma_px_;
  double pitch_mm_;
  double left_mm_ = 0;  // of the first column of rays, its edge
  std::vector<Row> rows_;
};

/// The furthest from the axis that a level ray of the projector's columns passes, mm.
[[nodiscard]] double lit_radius_mm(const model::Printer& printer);

}  // namespace vam::sim
