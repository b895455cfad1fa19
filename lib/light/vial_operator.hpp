// Light of the real projector: chief rays that diverge, are refracted by bath, glass and resin, and converge in the
// vial. What is optimised with it needs no resampling.
#pragma once

#include "light/operator.hpp"
#include "light/vial_rays.hpp"
#include "light/vial_shadows.hpp"
#include "tomo/filter.hpp"

namespace vam::light {

/// A sinogram has the columns of the projector that light the circle, and all stage angles: opposite rays run through
/// the vial on different lines. Slices light their own voxels (the rays' tilt along the axis is left to the target's
/// stretch, 1 / M_vp of physics section 2). A* is the chief-ray dose of [RAY21 eq 8]; A, its transpose, takes the same
/// weights.
class VialOperator final : public Operator {
 public:
  /// `inserts`: opaque objects in the light's way, a slab of coverage for every slab of the pass, or none; the spans
  /// of forward and adjoint are then the pass's slabs from the first on. Throws Fault::data as VialRays does.
  explicit VialOperator(const VialSetup& setup, std::span<const Slab> inserts = {});

  [[nodiscard]] Shape object() const override { return {rays_.setup().grid.nx, rays_.setup().grid.ny}; }
  [[nodiscard]] Shape sinogram() const override { return {rays_.columns(), rays_.setup().turn.rows}; }
  [[nodiscard]] Shape image() const override { return {rays_.setup().projector.columns, rays_.setup().turn.rows}; }
  [[nodiscard]] double row_angle_rad() const override;
  void forward(std::span<const Slab> objects, std::span<Slab> sinograms) const override;
  void adjoint(std::span<const Slab> sinograms, std::span<Slab> objects) const override;
  void filter(std::span<Slab> sinograms) const override;
  void precondition(std::span<Slab> sinograms) const override;
  void expand(const Slab& sinogram, Slab& image) const override;
  void collapse(const Slab& image, Slab& sinogram) const override;

 private:
  struct Kernels;
  struct Group;
  [[nodiscard]] std::vector<Group> groups(std::size_t slabs) const;
  void apply(const tomo::Filter& filter, std::span<Slab> sinograms) const;
  void light_up(const Group& group, int row, std::span<const Slab> sinograms, float* light) const;
  void take_back(const Group& group, int row, const float* light, std::span<Slab> sinograms) const;
  void give_tile(const Group& group, int tile, std::span<const Slab> objects, int row, int rows, float* light) const;
  void take_tile(const Group& group, int tile, const float* light, std::span<Slab> objects) const;

  VialRays rays_;
  VialShadows shadows_;
  const Kernels& kernels_;
  tomo::Filter ramp_, preconditioner_;
};

}  // namespace vam::light
