// SPDX-License-Identifier: GPL-3.0-or-later
// Shadow of opaque inserts (overprinting) [CAL19 fig 4]: how far along its ray the light of a pixel reaches.
#pragma once

#include <functional>
#include <limits>
#include <span>
#include <vector>

#include "base/compute/slab.hpp"
#include "model/grid.hpp"

namespace vam::light {

/// The way of a pixel's ray through the vial at one part angle theta: its plan view is L(offset, theta + delta) =
/// { offset (cos, sin) + u (-sin, cos) } [physics §1], its height in slices slice + climb * u. Without `hits` there is
/// no ray.
struct PixelRay {
  bool hits = true;
  double offset_mm = 0;
  double delta_rad = 0;
  double slice = 0;
  double climb_per_mm = 0;

  /// As a part sees it that stands off by (x, y) and `slices` up, before it is turned by theta.
  [[nodiscard]] PixelRay seen_from(double x_mm, double y_mm, double slices) const;
};

/// Every ray is followed voxel by voxel through the insert, up to the first voxel that is at least half covered: there
/// its light ends, whatever the insert's form. Rays have no width.
class InsertShadow {
 public:
  static constexpr float unhindered = std::numeric_limits<float>::infinity();

  InsertShadow() = default;
  /// Of a pixel: rays that are the same at all angles are given for angle 0 only.
  using Rays = std::function<PixelRay(int column, int row, int angle)>;
  /// `inserts`: coverage, a slab for every slab of slices. Rows as many as `row_slabs` hold.
  InsertShadow(const model::Grid& grid, std::span<const Slab> inserts, std::span<const double> part_angles_rad,
               int columns, int row_slabs, bool same_at_all_angles, const Rays& ray);

  [[nodiscard]] bool empty() const { return ends_.empty(); }

  /// u in mm of a point of the part on the ray of that column and angle; the ray's plan view taken as level.
  [[nodiscard]] float depth_mm(double x_mm, double y_mm, int angle, int column) const {
    const PlanDirection& ray = rays_[at(column, angle)];
    return static_cast<float>(y_mm * ray.cosine - x_mm * ray.sine);
  }

  /// Whether any row's ray of that column and angle meets the insert.
  [[nodiscard]] bool occludes(int column, int angle) const { return occludes_[at(column, angle)] != 0; }

  /// u in mm at which rays meet the insert, or `unhindered`: a slab of columns x angles for 16 rows each.
  [[nodiscard]] std::span<const Slab> ends() const { return ends_; }

 private:
  struct PlanDirection {
    double cosine, sine;
  };
  struct Body;
  [[nodiscard]] std::size_t at(int column, int angle) const {
    return static_cast<std::size_t>(column) * angles_ + angle;
  }
  void note_hindered(int columns);
  [[nodiscard]] float follow(const Body& body, const PixelRay& ray, double part_angle_rad) const;

  model::Grid grid_;
  std::size_t angles_ = 0;
  std::vector<PlanDirection> rays_;      // in plan, of a row in the middle: [column][angle]
  std::vector<Slab> ends_;               // columns x angles, 16 rows
  std::vector<unsigned char> occludes_;  // [column][angle]
};

}  // namespace vam::light
