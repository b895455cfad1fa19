// Opaque inserts in the vial's own light (overprinting) [CAL19 fig 4].
#pragma once

#include <span>
#include <vector>

#include "base/slab.hpp"
#include "light/vial_rays.hpp"

namespace vam::light {

/// A ray carries no light behind the first insert voxel that it meets: the point (t, u) is lit at a stage angle if u is
/// less than where the ray of its column meets the insert. Slower than without: every slice has shadows of its own.
class VialShadows {
 public:
  /// `inserts`: coverage of the opaque object, a slab for every slab of the pass; opaque from a half on.
  VialShadows(const VialRays& rays, std::span<const Slab> inserts);

  [[nodiscard]] bool empty() const { return reach_.empty(); }

  /// What vial_gather and vial_scatter do, for one slab and where the insert lets light through: voxel (i, j), rows
  /// [row, row + rows), `light` beginning at `row`.
  void gather(std::size_t slab, int i, int j, int row, int rows, const VialTaps& taps, const float* light,
              float* voxel) const;
  void scatter(std::size_t slab, int i, int j, int row, int rows, const VialTaps& taps, const float* voxel,
               float* light) const;

 private:
  /// The columns that see a voxel at stage angle `row`, and how far its near side is before its middle.
  struct Sight {
    int first, last;
    float near_mm;
  };
  [[nodiscard]] Sight sight(const VialTaps& taps, int r, int row) const;
  void cast(const VialRays& rays, const Slab& insert, Slab& reach) const;
  [[nodiscard]] float depth(int i, int j, int row, int column) const;
  /// visit(offset of the ray's light, lane, weight), weight 0 in the shadow: what gather and scatter share.
  template <class Visit>
  void each_ray(const Slab& reach, int i, int j, int row, int rows, const VialTaps& taps, const Visit& visit) const;

  struct Direction {
    double cosine, sine;
  };
  model::Grid grid_;
  int stride_ = 0;
  std::vector<Direction> rows_;     // where the part stands
  std::vector<Direction> columns_;  // of the rays' lines in the vial, per column of a row of light
  std::vector<double> half_;        // half a voxel in columns, per column
  std::vector<Slab> reach_;         // the u in mm up to which light gets, per column, row and slice
};

}  // namespace vam::light
