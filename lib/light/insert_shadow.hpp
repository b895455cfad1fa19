// Opaque inserts in the light (overprinting) [CAL19 fig 4]: how far along its ray the light of a column gets.
#pragma once

#include <limits>
#include <span>
#include <vector>

#include "base/image.hpp"
#include "model/grid.hpp"

namespace vam::light {

/// The line of a column's ray in the resin: at part angle theta it is L(offset, theta + delta) =
/// { offset (cos, sin) + u (-sin, cos) } [physics section 1]. Without `hits` there is no ray.
struct RayLine {
  bool hits = true;
  double offset_mm = 0;
  double delta_rad = 0;
};

/// From a half on, coverage keeps light out.
[[nodiscard]] constexpr bool opaque(float coverage) { return coverage >= 0.5F; }

/// Where up to 16 slices lie in shadow. Every ray is followed voxel by voxel through the insert, up to the first voxel
/// that is at least half covered: there its light ends, whatever the insert's form. Rays have no width.
class InsertShadow {
 public:
  static constexpr int lanes = 16;
  static constexpr float unhindered = std::numeric_limits<float>::infinity();

  /// The rays of a turn: part angles in rad, a line per column.
  InsertShadow(const model::Grid& grid, std::span<const double> angles_rad, std::span<const RayLine> columns);

  /// Follows the rays through inserts: coverage (nx x ny), one a slice, at most 16. Throws Fault::data where one has
  /// another shape than the grid.
  void cast(std::span<const Image> inserts);

  /// u in mm of a point of the part on the ray of that column and angle.
  [[nodiscard]] float depth_mm(double x_mm, double y_mm, int row, int column) const {
    const Direction& part = rows_[static_cast<std::size_t>(row)];
    const Direction& ray = columns_[static_cast<std::size_t>(column)];
    const double x = x_mm * part.cosine + y_mm * part.sine;
    const double y = y_mm * part.cosine - x_mm * part.sine;
    return static_cast<float>(y * ray.cosine - x * ray.sine);
  }

  /// u in mm at which the ray meets the insert, or `unhindered`.
  [[nodiscard]] float end_mm(int row, int column, int slice) const { return ends(row, column)[slice]; }

  /// dose += weight * light in the slices in which the ray is still under way at that depth.
  void add(int row, int column, float depth, float weight, const float* light, float* dose) const {
    const float* end = ends(row, column);
    for (int s = 0; s < lanes; ++s) dose[s] += depth < end[s] ? weight * light[s] : 0.0F;
  }

 private:
  struct Direction {
    double cosine, sine;
  };
  struct Opaque;
  [[nodiscard]] float follow(const Opaque& insert, int row, int column) const;
  [[nodiscard]] std::size_t at(int row, int column) const {
    return (static_cast<std::size_t>(row) * columns_.size() + static_cast<std::size_t>(column)) * lanes;
  }
  [[nodiscard]] const float* ends(int row, int column) const { return ends_.data() + at(row, column); }

  model::Grid grid_;
  std::vector<RayLine> lines_;
  std::vector<Direction> rows_, columns_;
  std::vector<float> ends_;  // [row][column][slice]
};

/// No dose in the voxels that are at least half insert.
void darken(std::span<const Image> inserts, std::span<Image> doses);

}  // namespace vam::light
