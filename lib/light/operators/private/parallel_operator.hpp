// SPDX-License-Identifier: GPL-3.0-or-later
// A and A* of parallel light through clear resin: the matched pairs of lib/tomo.
#pragma once

#include "light/operators/make_operator.hpp"
#include "light/operators/operator.hpp"
#include "light/operators/private/preconditioner.hpp"
#include "tomo/fourier_radon.hpp"
#include "tomo/radon.hpp"

namespace vam::light {

/// Lines (t, theta) and (-t, theta + pi) are the same, so light from either side gives the same dose, and an optimum
/// may be sought among sinograms that are equal on both: an even number of angles over a full turn needs half of the
/// rows, each standing for itself and its mirror image, and half of the time.
class ParallelOperator final : public Operator {
 public:
  /// `turn` covers 360 degrees, its end excluded. Throws Fault::usage when sizes are not positive.
  explicit ParallelOperator(const tomo::ParallelGeometry& turn, LineIntegrals integrals = LineIntegrals::footprints);

  [[nodiscard]] Shape object() const override { return {rows_.nx, rows_.ny}; }
  [[nodiscard]] Shape sinogram() const override { return {rows_.columns, rows_.angles}; }
  [[nodiscard]] Shape image() const override { return {turn_.columns, turn_.angles}; }
  [[nodiscard]] double row_angle_rad() const override { return row_angle_rad_; }
  void forward(std::span<const Slab> objects, std::span<Slab> sinograms) const override;
  void adjoint(std::span<const Slab> sinograms, std::span<Slab> objects) const override;
  void filter(std::span<Slab> sinograms) const override { inverse_.filter(sinograms); }
  void precondition(std::span<Slab> sinograms) const override { inverse_.precondition(sinograms); }
  [[nodiscard]] std::unique_ptr<Operator> for_one_slice() const override;
  void expand(const Slab& sinogram, Slab& image) const override;
  void collapse(const Slab& image, Slab& sinogram) const override;

 private:
  [[nodiscard]] bool halved() const { return rows_.angles != turn_.angles; }
  tomo::ParallelGeometry turn_;
  tomo::ParallelGeometry rows_;  // the rows that are unknowns: half a turn when halved
  double row_angle_rad_;         // the angle a row stands for
  Preconditioner inverse_;
  std::unique_ptr<tomo::FourierRadon> fourier_;  // none: footprints
};

}  // namespace vam::light
