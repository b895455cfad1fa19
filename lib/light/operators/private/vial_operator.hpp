// SPDX-License-Identifier: GPL-3.0-or-later
// A and A* of the real projector: chief rays that diverge, climb, are refracted by bath, glass and resin, and converge
// in the vial. Sinograms that are optimised with it need no resampling.
#pragma once

#include "light/operators/operator.hpp"
#include "light/operators/private/insert_shadow.hpp"
#include "light/operators/private/preconditioner.hpp"
#include "light/operators/private/tile_light.hpp"
#include "light/rays/vial_rays.hpp"

namespace vam::light {

/// A sinogram has the columns of the projector that light the circle, and all stage angles: opposite rays run through
/// the vial on different lines. A* is the sum of what chief_ray_dose.hpp has [physics §4, §11]; A, its
/// transpose, takes the same weights. A projector whose rays climb lights slices with the rows of others: slices and
/// rows of a pass are then the whole grid's, and rows beyond setup.rows, slices beyond grid.nz are dark. A projector
/// whose rays stay level lights each slice with its own row, and any slices may share a pass.
class VialOperator final : public Operator {
 public:
  /// `inserts`: opaque objects in the light's way, a slab of coverage for every slab of the pass, or none; the spans
  /// of forward and adjoint are then the pass's slabs from the first on. Throws Fault::data as VialRays does.
  explicit VialOperator(const VialSetup& setup, std::span<const Slab> inserts = {});

  [[nodiscard]] Shape object() const override { return {rays_.setup().grid.nx, rays_.setup().grid.ny}; }
  [[nodiscard]] Shape sinogram() const override { return {rays_.columns(), rays_.setup().turn.rows}; }
  [[nodiscard]] Shape image() const override { return {rays_.setup().projector.columns, rays_.setup().turn.rows}; }
  [[nodiscard]] double row_angle_rad() const override;
  [[nodiscard]] bool couples_slices() const override { return rays_.climbs(); }
  [[nodiscard]] bool rows_are_slices() const override { return !rays_.posed(); }
  void forward(std::span<const Slab> objects, std::span<Slab> sinograms) const override;
  void adjoint(std::span<const Slab> sinograms, std::span<Slab> objects) const override;
  [[nodiscard]] SlabRange lit_by(const SlabRange& objects) const override;
  void forward_within(const Window<const Slab>& objects, const Window<Slab>& sinograms) const override;
  void adjoint_within(const Window<const Slab>& sinograms, const Window<Slab>& objects) const override;
  void filter(std::span<Slab> sinograms) const override { inverse_.filter(sinograms); }
  void precondition(std::span<Slab> sinograms) const override { inverse_.precondition(sinograms); }
  void expand(const Slab& sinogram, Slab& image) const override;
  void collapse(const Slab& image, Slab& sinogram) const override;

 private:
  template <class Visit>
  void each_chunk(const SlabRange& slabs, const Visit& visit) const;

  VialRays rays_;
  std::vector<Tile> tiles_;
  InsertShadow shadow_;
  RayNodes level_;  // of every chunk, where rays do not climb
  Preconditioner inverse_;
};

}  // namespace vam::light
