// SPDX-License-Identifier: GPL-3.0-or-later
// Table of the rays of the projector through a point of the laboratory, with their strength and density, over polar
// coordinates of the plan view, made from the chief rays alone. The geometry does not depend on the stage angle, so one
// table serves every voxel at every angle.
#pragma once

#include <array>
#include <cstddef>
#include <map>
#include <memory>
#include <mutex>
#include <vector>

#include "base/compute/slab.hpp"
#include "light/rays/private/light_spread.hpp"
#include "light/rays/private/taps_kernel.hpp"
#include "optics/chief_ray.hpp"

namespace vam::light {

/// From millimetres of the image plane to columns, rows and voxels.
struct RayScale {
  double columns_per_mm = 1;
  double column_origin = 0;
  double rows_per_mm = 1;
  double row_origin = 0;
  double rows_per_slice = 1;     // where d z_p / d z is 1
  double columns_per_voxel = 1;  // where d x_p / d r is 1
};

/// The scale at one height.
struct HeightScale {
  float z2;  // (height / largest height)^2
  float columns_per_mm, column_origin;
  float row_rate, row_origin;
  float rows_per_slice, columns_per_voxel;
};

/// A point of the table: coefficients of 1, z^2 and z^4, z in units of the largest height.
struct TableNode {
  using Even = std::array<float, 3>;
  Even x_p{}, row{1}, strength{}, spacing{1};  // z_p = z * row(z^2)
  float cosine = 1, sine = 0;                  // of the ray's angle in plan
};

/// The depth of a point of the plan view on the ray.
inline float depth_mm(const TableNode& node, float x_mm, float y_mm) { return y_mm * node.cosine - x_mm * node.sine; }

/// The node at one height, the point (x, y) of the plan view.
inline RayNode node_at(const TableNode& node, const HeightScale& scale, const LightSpread& spread, float x_mm,
                       float y_mm) {
  const float z2 = scale.z2;
  const auto value = [z2](const TableNode::Even& even) { return even[0] + z2 * (even[1] + z2 * even[2]); };
  const float g = value(node.row);
  const float g_rate = 2 * z2 * (node.row[1] + 2 * z2 * node.row[2]);  // z dg/dz
  const float strength = value(node.strength);
  const float x_p = value(node.x_p);
  const float spacing = value(node.spacing);
  return {scale.columns_per_mm * x_p + scale.column_origin,
          scale.row_rate * g + scale.row_origin,
          scale.rows_per_slice * (g + g_rate),
          strength > 0 ? strength : 0.0F,
          scale.columns_per_voxel * spacing,
          node.cosine,
          node.sine,
          spread.across() ? spread.across2(x_p, depth_mm(node, x_mm, y_mm), scale.columns_per_mm * spacing) : 0.0F};
}

struct ChiefRayDose;
class DisplacedVial;

using RayNodes = std::vector<RayNode, CacheAligned<RayNode>>;

/// Points at lab polar coordinates (r, alpha) of the rays' plan views { t (cos d, sin d) + u (-sin d, cos d) }.
///
/// Within the reach every point of the plan has one ray from each side, found by Newton's method at three heights;
/// between these, columns, strength and density are polynomials in z^2 (by symmetry), rows z times one: exact to 1e-4
/// of a pixel for any height that a projector has. Beyond the reach the rays of one stage angle fold (caustics): a
/// point has up to four rays, or none. These rows are filled ray by ray, which keeps the power, and hold the means over
/// a voxel; there the climb is that of low rays.
class RayTable {
 public:
  static constexpr int most_sheets = 4;        // front; rear: fold, middle, fold
  static constexpr int circles_per_voxel = 4;  // rays of the outer rows are counted on
  struct RowPair {
    int low, high;
    float part;  // of the way from low to high
  };
  struct Zone {
    double first_mm = 0;  // radius of row 0
    double pitch_mm = 0;
    int rows = 0;
    int sheets = 1;     // branches of the map
    int first_row = 0;  // of the table

    /// The rows on either side of a radius, or the zone's end.
    [[nodiscard]] RowPair rows_at(double r_mm) const;
  };

  /// What it is a table of.
  struct Scope {
    optics::View view;
    int angles = 0;  // stage angles of one turn
    int sense = 1;   // +1 when alpha grows with the index
    double absorption_per_mm = 0;
    double r_max_mm = 0;   // radii up to this are needed
    double voxel_mm = 0;   // edge of a voxel
    double height_mm = 0;  // largest |z| above or below the lens's axis that is needed
    bool operator==(const Scope&) const = default;
  };
  explicit RayTable(const Scope& scope);
  /// One that is in use, where there is one of that scope: printers that differ in what is not of it share their rays.
  [[nodiscard]] static std::shared_ptr<const RayTable> of(const Scope& scope);

  [[nodiscard]] HeightScale scale_at(double z_mm, const RayScale& scale) const;
  /// The nodes at that height: element row_begin(zone, row, sheet) + i is direction alpha = sense * i * 2 pi /
  /// directions, i = 0 to directions.
  void at_height(double z_mm, const RayScale& scale, const LightSpread& spread, RayNodes& nodes) const;
  [[nodiscard]] std::size_t row_begin(const Zone& zone, int row, int sheet) const {
    return static_cast<std::size_t>(zone.first_row + row * zone.sheets + sheet) *
           static_cast<std::size_t>(directions + 1);
  }
  /// Its `directions` points.
  [[nodiscard]] const TableNode* points(const Zone& zone, int row, int sheet) const {
    return nodes_.data() + static_cast<std::ptrdiff_t>(zone.first_row + row * zone.sheets + sheet) * directions;
  }
  [[nodiscard]] bool climbs() const { return climbs_; }
  /// What changes where the vial is displaced by up to so much: made when it is first asked for.
  [[nodiscard]] std::shared_ptr<const DisplacedVial> displaced(double largest_mm) const;
  /// Standard deviation of the spread along z of the light that passes a point of the plan view, in mm of the image
  /// plane.
  [[nodiscard]] double spread_along_mm(double x_mm, double y_mm, const LightSpread& spread) const;
  /// Largest change of x_p, in mm of the image plane, from one height to another, at that radius.
  [[nodiscard]] double drift_mm(double from_mm, double to_mm, double r_mm) const;

  int phases = 0;      // directions a stage angle
  int directions = 0;  // of a turn
  double reach_mm = 0;
  double edge_mm = 0;  // radius of the resin
  Zone inner;
  double inner_edge_mm = 0;  // up to where it is used: its last row, or the reach, before which it ends by a hair
  Zone outer;                // from there on; no rows where no voxel is beyond the reach

 private:
  void fill_inner_row(const ChiefRayDose& light, int row);
  [[nodiscard]] TableNode inner_node(const ChiefRayDose& light, double r_mm, double alpha, double& b_rad) const;
  void fill_outer_rows(const ChiefRayDose& light, int first, int end);
  void continue_outer_row(int row);
  [[nodiscard]] TableNode* row_of(const Zone& zone, int row, int sheet) {
    return nodes_.data() + static_cast<std::ptrdiff_t>(zone.first_row + row * zone.sheets + sheet) * directions;
  }

  Scope scope_;
  bool climbs_ = false;
  std::vector<float> cosines_, sines_;  // of the directions
  std::vector<TableNode> nodes_;        // [zone, row, sheet][direction]
  mutable std::mutex guard_;
  mutable std::map<double, std::shared_ptr<const DisplacedVial>> displaced_;
};

}  // namespace vam::light
