// Parallel light around an opaque insert (overprinting) [CAL19 fig 4].
#pragma once

#include <cmath>
#include <vector>

#include "light/insert_shadow.hpp"
#include "light/operator.hpp"
#include "tomo/filter.hpp"
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
  void filter(std::span<Slab> sinograms) const override;
  void precondition(std::span<Slab> sinograms) const override;
  void expand(const Slab& sinogram, Slab& image) const override;
  void collapse(const Slab& image, Slab& sinogram) const override;

 private:
  /// Where a voxel's shadow falls at one angle: columns first, first + 1, ... with weights that add up to 1.
  struct Footprint {
    double u;
    int first;
    float weight[4];
  };
  [[nodiscard]] Footprint footprint(int x, int y, int angle) const;
  void apply(const tomo::Filter& filter, std::span<Slab> sinograms) const;
  [[nodiscard]] float left(int column, double u) const;  // e^{-mu s}

  tomo::ParallelGeometry turn_;
  double mu_;
  std::vector<double> depth_;  // sqrt(R^2 - t^2) of each column
  std::vector<double> cosine_, sine_;
  InsertShadow shadow_;
  tomo::Filter ramp_, preconditioner_;
};

}  // namespace vam::light
