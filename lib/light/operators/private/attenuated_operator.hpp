// SPDX-License-Identifier: GPL-3.0-or-later
// A and A* of parallel light through resin that absorbs, D = sum F e^{-mu s}, and its exact inverse [physics §4, §5].
#pragma once

#include <cmath>
#include <vector>

#include "light/operators/make_operator.hpp"
#include "light/operators/operator.hpp"
#include "light/operators/private/preconditioner.hpp"
#include "tomo/filtered_projections.hpp"
#include "tomo/radon.hpp"

namespace vam::light {

/// Light enters at the resin's radius R and is e^{-mu s} as strong (Beer-Lambert), s = sqrt(R^2 - t^2) + u, at (t, u)
/// [CAL19 eq 1; physics §4]; fluence is that at entry. Both sides of a turn differ, so every stage angle is an
/// unknown.
class AttenuatedOperator final : public Operator {
 public:
  /// mu and R in 1/px and px. Throws Fault::data when e^{mu u} overflows.
  AttenuatedOperator(const tomo::ParallelGeometry& turn, double mu_per_px, double resin_radius_px,
                     Correction correction = Correction::exact);

  [[nodiscard]] Shape object() const override { return {dose_.nx, dose_.ny}; }
  [[nodiscard]] Shape sinogram() const override { return image(); }
  [[nodiscard]] Shape image() const override { return {dose_.columns, dose_.angles}; }
  [[nodiscard]] double row_angle_rad() const override { return std::abs(dose_.angle_step_rad); }
  void forward(std::span<const Slab> objects, std::span<Slab> sinograms) const override;
  void adjoint(std::span<const Slab> sinograms, std::span<Slab> objects) const override;
  void filter(std::span<Slab> sinograms) const override { inverse_.filter(sinograms); }
  void precondition(std::span<Slab> sinograms) const override { inverse_.precondition(sinograms); }
  void invert(std::span<const Slab> objects, std::span<Slab> sinograms) const override;

 private:
  void divide_by_disc_dose(std::span<Slab> objects) const;

  tomo::ParallelGeometry dose_;  // weight e^{-mu u}
  double radius_px_;
  Correction correction_;
  std::vector<float> transmitted_;  // e^{-mu sqrt(R^2 - t^2)}: what is left of the light of a column at the axis' plane
  std::vector<float> amplified_;    // 1 / transmitted
  Preconditioner inverse_;
  Preconditioner clear_;             // of resin that does not absorb
  tomo::FilteredProjections exact_;  // with weight e^{mu u}, and the light at the wall
};

}  // namespace vam::light
