// The parallel dose around an opaque insert.
#pragma once

#include <span>

#include "base/image.hpp"
#include "light/insert_shadow.hpp"
#include "model/grid.hpp"
#include "tomo/radon.hpp"

namespace vam::light {

/// tomo::adjoint, where light ends at the insert: a voxel takes from each column the part of its trapezoid footprint
/// that falls on it, if the column's ray gets that far.
class ShadowedTurn {
 public:
  ShadowedTurn(const tomo::ParallelGeometry& geometry, const model::Grid& grid, double column_mm);

  /// The slices of one slab and their inserts.
  void back_project(const Slab& sinogram, std::span<const Image> inserts, Slab& image);

 private:
  void add_light(const Slab& sinogram, int x, int y, int angle, float* dose) const;

  struct Angle {
    double cosine, sine;
  };
  tomo::ParallelGeometry geometry_;
  model::Grid grid_;
  std::vector<Angle> angles_;
  light::InsertShadow shadow_;
};

}  // namespace vam::light
