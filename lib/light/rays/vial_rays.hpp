// SPDX-License-Identifier: GPL-3.0-or-later
// Columns and rows of the projector that light a voxel of the turning vial, and their weights.
#pragma once

#include <memory>
#include <vector>

#include "base/index.hpp"
#include "light/rays/private/posed_rays.hpp"
#include "light/rays/private/ray_table.hpp"
#include "light/rays/row_spread.hpp"
#include "light/rays/vial_setup.hpp"

namespace vam::light {

/// Rows [first, end) of light.
struct RowRange {
  int first = 0;
  int end = 0;
};

/// A pixel is a box of even intensity; it leaves fluence T * density * e^{-mu path} at the voxels on its ray
/// [physics §11]. The mean over a voxel's shadow is exact across the columns, and linear
/// between rows.
class VialRays {
 public:
  /// Throws Fault::data unless the rows are one turn or have poses, when no column of the projector lights the resin,
  /// when the lens is so near that rays climb too steeply, and for poses that displace the vial too far.
  explicit VialRays(const VialSetup& setup);

  [[nodiscard]] const VialSetup& setup() const { return setup_; }
  /// Whether voxels stand elsewhere in every frame: then rays are found for each of them, posed_rays(); else by the
  /// table at a height, at_slices() and find_taps().
  [[nodiscard]] bool posed() const { return !setup_.poses.empty(); }
  /// Whether rows light other slices than their own.
  [[nodiscard]] bool climbs() const { return table_->climbs() || posed(); }
  /// 4 where grid and stage angles are the same after a quarter of a turn, else 1.
  [[nodiscard]] int quarters() const;
  /// The stage angle at which voxels so many quarters of a turn on have the rays that these have at `angle`.
  [[nodiscard]] int turned_angle(int angle, int quarters) const;
  /// The columns that light voxels: columns() from first_column() of the projector on.
  [[nodiscard]] int first_column() const { return first_; }
  [[nodiscard]] int columns() const { return count_of(transmitted_); }
  /// T e^{-mu sqrt(R^2 - t^2)} of a column: the fraction that reaches the plane of the axis.
  [[nodiscard]] double transmitted(int column) const { return transmitted_[column]; }
  /// Slices that may share the rays of voxel columns up to that radius: 64, 32 or 16, so that these drift by less than
  /// 0.12 columns from the middle to the end. Over all slices and directions that is some 0.03 columns (RMS), and no
  /// two stage angles err alike.
  [[nodiscard]] int chunk(double r_mm) const;

  /// A row of light has columns() and this many dark columns before and after.
  [[nodiscard]] int padding() const { return taps_; }
  [[nodiscard]] int taps() const { return taps_; }

  /// A voxel column as the table knows it: up to four rays a stage angle (beyond the reach; one within it). Returns how
  /// many.
  static constexpr int most_rays = RayTable::most_sheets;
  int find(int i, int j, RaySource* rays) const;

  /// The table at the height of the middle of `slices` slices from `first` on.
  void at_slices(int first, int slices, RayNodes& nodes) const;
  /// Where `count` rays, whole blocks of them, take light from at a stage angle.
  void find_taps(const RayNodes& nodes, const RaySource* rays, int count, int angle, int slices, RayTaps& taps) const;

  /// Whether light of a frame may reach these slices.
  [[nodiscard]] bool lit(int first, int slices, int frame) const;
  /// The scale at the middle of these slices in a frame.
  [[nodiscard]] HeightScale posed_scale(int first, int slices, int frame) const;
  /// Nodes of the rays through a voxel column, at most most_rays; returns how many.
  int find_posed(int i, int j, int frame, const HeightScale& scale, RayNode* to) const {
    return posed_.find(*table_, setup_.grid.x_mm(i), setup_.grid.y_mm(j), frame, scale, widths_, to);
  }
  /// Where `count` rays, whole blocks of them, take light from: one node each, and one more.
  void find_posed_taps(const RayNodes& nodes, int count, int frame, int slices, RayTaps& taps) const;

  /// Light of a row spreads to its neighbours by these kernels.
  [[nodiscard]] const RowSpread& spread() const { return spread_; }
  /// By which standard deviation in rows, at a voxel column at that stage angle.
  [[nodiscard]] double spread_rows(int i, int j, int angle) const;

  /// The rows that these slices take light from, `nodes` those at_slices(); with poses, in any frame, rather too many.
  [[nodiscard]] RowRange rows_to(const RayNodes& nodes, int first, int slices) const;

  /// The rows that may be lit.
  [[nodiscard]] int first_row() const { return first_row_; }
  [[nodiscard]] int end_row() const { return end_row_; }
  /// z_p of a row.
  [[nodiscard]] double row_mm(double row) const { return setup_.first_row_mm + row * setup_.grid.voxel_mm; }

 private:
  /// How the part stands, as RayFrame has it.
  struct PartTurn {
    int shift, step, directions;
    float cosine, sine;
  };
  void take_from(const RayNodes& nodes, const RaySource* rays, int count, const PartTurn& part, int slices,
                 RayTaps& taps) const;
  [[nodiscard]] int sense() const { return (setup_.turn.step_rad < 0 ? 1 : -1) * setup_.direction; }
  [[nodiscard]] double height_mm(double slice) const { return setup_.z_scale * setup_.grid.z_mm(slice); }
  [[nodiscard]] double top_mm() const;
  [[nodiscard]] RayTable::Scope table_scope() const;
  [[nodiscard]] RayScale scale() const;
  void require_moderate_rays(RayNodes& nodes) const;
  void note_columns();
  void note_rows();
  void note_spread();
  [[nodiscard]] RowRange posed_rows_to(int first, int slices) const;

  VialSetup setup_;
  std::shared_ptr<const RayTable> table_;
  LightSpread widths_;
  PosedRays posed_;
  RowSpread spread_;
  float least_row_ = 1, most_row_ = 1;  // z_p over height, of any ray
  int first_ = 0;
  int first_row_ = 0;
  int end_row_ = 0;
  int taps_ = 0;
  std::vector<double> transmitted_;
  std::vector<float> cosines_, sines_;  // of the part's angles
};

}  // namespace vam::light
