// SPDX-License-Identifier: GPL-3.0-or-later
// A and A* of parallel light for a single slice, which would leave 15 of 16 lanes idle.
#pragma once

#include "light/operators/private/parallel_operator.hpp"

namespace vam::light {

/// On a square grid about the axis, a slice that is turned by 90 degrees, mirrored, or both has the projections of
/// other angles of the half turn: four lanes of copies take an eighth of a turn. Lane 0 of a slab is its slice, the
/// others are not read, and written as 0. Agrees with the ParallelOperator but for rounding.
class OneSliceOperator final : public Operator {
 public:
  [[nodiscard]] static bool is_for(const tomo::ParallelGeometry& turn);
  explicit OneSliceOperator(const tomo::ParallelGeometry& turn);

  [[nodiscard]] Shape object() const override { return all_.object(); }
  [[nodiscard]] Shape sinogram() const override { return all_.sinogram(); }
  [[nodiscard]] Shape image() const override { return all_.image(); }
  [[nodiscard]] double row_angle_rad() const override { return all_.row_angle_rad(); }
  void forward(std::span<const Slab> objects, std::span<Slab> sinograms) const override;
  void adjoint(std::span<const Slab> sinograms, std::span<Slab> objects) const override;
  void filter(std::span<Slab> sinograms) const override { all_.filter(sinograms); }
  void precondition(std::span<Slab> sinograms) const override { all_.precondition(sinograms); }
  void expand(const Slab& sinogram, Slab& image) const override { all_.expand(sinogram, image); }
  void collapse(const Slab& image, Slab& sinogram) const override { all_.collapse(image, sinogram); }

 private:
  /// The row of the half turn that a copy has at this row of the eighth.
  [[nodiscard]] int row_of(int copy, int row) const;
  /// At either end of the eighth two copies have the same rows.
  [[nodiscard]] bool is_repeated(int copy, int row) const;

  ParallelOperator all_;
  tomo::ParallelGeometry eighth_;
};

}  // namespace vam::light
