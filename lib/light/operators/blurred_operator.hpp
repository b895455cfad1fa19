// SPDX-License-Identifier: GPL-3.0-or-later
// The operator with the blur of beam and resin inside: the projections then compensate for it.
#pragma once

#include <memory>

#include "light/operators/operator.hpp"

namespace vam::light {

class GaussianBlur;

/// Dose = B A* g, where B is the Gaussian of the beam's point spread and of diffusion [physics §4],
/// that of light::BlurStream, across the slices and from one to the next: the slices of a pass lie one above the other.
/// What is outside the grid or the pass is dark, so B is symmetric and A B its adjoint.
class BlurredOperator final : public Operator {
 public:
  /// `sharp` must outlive this. sigma in voxels; `slices` are in use.
  BlurredOperator(const Operator& sharp, double sigma_px, int slices);
  ~BlurredOperator() override;

  [[nodiscard]] Shape object() const override { return sharp_.object(); }
  [[nodiscard]] Shape sinogram() const override { return sharp_.sinogram(); }
  [[nodiscard]] Shape image() const override { return sharp_.image(); }
  [[nodiscard]] double row_angle_rad() const override { return sharp_.row_angle_rad(); }
  [[nodiscard]] bool couples_slices() const override { return true; }
  [[nodiscard]] bool rows_are_slices() const override { return sharp_.rows_are_slices(); }
  /// The spans are the pass's slabs from the first on.
  void forward(std::span<const Slab> objects, std::span<Slab> sinograms) const override;
  void adjoint(std::span<const Slab> sinograms, std::span<Slab> objects) const override;
  /// All rows that light the grid.
  [[nodiscard]] SlabRange lit_by(const SlabRange& objects) const override;
  void filter(std::span<Slab> sinograms) const override { sharp_.filter(sinograms); }
  void precondition(std::span<Slab> sinograms) const override { sharp_.precondition(sinograms); }
  void invert(std::span<const Slab> objects, std::span<Slab> sinograms) const override {
    sharp_.invert(objects, sinograms);
  }
  void expand(const Slab& sinogram, Slab& image) const override { sharp_.expand(sinogram, image); }
  void collapse(const Slab& image, Slab& sinogram) const override { sharp_.collapse(image, sinogram); }

 private:
  void blur(std::span<Slab> objects) const;
  void blur_stack(std::span<Slab> objects, int y) const;

  const Operator& sharp_;
  int slices_;
  std::unique_ptr<GaussianBlur> smear_;
};

/// Slices on either side that a slice must know: three sigma.
[[nodiscard]] int halo_slices(double sigma_px);

}  // namespace vam::light
