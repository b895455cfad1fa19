// SPDX-License-Identifier: GPL-3.0-or-later
// A and A* of parallel light around an opaque insert (overprinting) [CAL19 fig 4].
#pragma once

#include <cmath>
#include <vector>

#include "light/operators/operator.hpp"
#include "light/operators/private/insert_shadow.hpp"
#include "light/operators/private/preconditioner.hpp"
#include "tomo/radon.hpp"

namespace vam::light {

/// A ray carries no light behind the first insert voxel that it meets, whatever the insert's form: the point (t, u) is
/// lit from angle theta if u is less than where column t meets the insert. Absorption as in AttenuatedOperator. Both
/// maps take the same weights, so that they stay adjoint. Slower than the plain pair: every slice has shadows of its
/// own.
class ShadowedOperator final : public Operator {
 public:
  /// `inserts`: the opaque object's coverage, a slab for every slab of the pass; opaque from a half on. mu in 1/px.
  ShadowedOperator(const tomo::ParallelGeometry& turn, double mu_per_px, double resin_radius_px,
                   std::span<const Slab> inserts);

  [[nodiscard]] Shape object() const override { return {turn_.nx, turn_.ny}; }
  [[nodiscard]] Shape sinogram() const override { return image(); }
  [[nodiscard]] Shape image() const override { return {turn_.columns, turn_.angles}; }
  [[nodiscard]] double row_angle_rad() const override { return std::abs(turn_.angle_step_rad); }
  /// The spans are the pass's slabs from the first on.
  void forward(std::span<const Slab> objects, std::span<Slab> sinograms) const override;
  void adjoint(std::span<const Slab> sinograms, std::span<Slab> objects) const override;
  void filter(std::span<Slab> sinograms) const override { inverse_.filter(sinograms); }
  void precondition(std::span<Slab> sinograms) const override { inverse_.precondition(sinograms); }

 private:
  /// Where a voxel's shadow falls at one angle: columns first, first + 1, ... with weights that add up to 1.
  static constexpr int most_columns = 4;
  struct Footprint {
    double u;
    int first;
    float weight[most_columns];
  };
  struct Direction {
    double cosine, sine;
  };
  [[nodiscard]] Footprint footprint(int x, int y, int angle) const;
  /// visit(column, weight, u up to which each slice is lit): the columns that light a voxel, absorption included.
  template <class Visit>
  void each_column(const Footprint& footprint, std::size_t slab, int angle, const Visit& visit) const;

  tomo::ParallelGeometry turn_;
  double mu_;
  std::vector<double> depth_;  // sqrt(R^2 - t^2) of each column
  std::vector<Direction> directions_;
  InsertShadow shadow_;
  Preconditioner inverse_;  // as without shadows
};

}  // namespace vam::light
