// Which ray of the projector lights a point of the lab, how strongly and how densely: a table over polar coordinates
// of the plan view, made from the chief rays alone. The geometry does not depend on the stage angle, so one table
// serves every voxel at every angle.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "optics/vial.hpp"

namespace vam::light {

/// What the table holds of a node, at one height above the lens's axis.
struct RayNodes {
  std::vector<float> x_p_mm;    // column of the ray, in the image plane
  std::vector<float> z_p_mm;    // row of the ray, in the image plane
  std::vector<float> zoom;      // d z_p / d z
  std::vector<float> strength;  // fluence per image-plane intensity, e^{-mu path} included; 0 = no ray
  std::vector<float> spacing;   // d x_p / d r across the ray
  std::vector<float> cosine;    // of the ray's angle in plan
  std::vector<float> sine;
};

/// Points at lab polar coordinates (r, alpha) of the rays' plan views { t (cos d, sin d) + u (-sin d, cos d) }.
///
/// Within the reach every point of the plan has one ray from each side, found by Newton's method at three heights;
/// between these, columns, strength and density are polynomials in z^2 (by symmetry), rows z times one: exact to 1e-4
/// of a pixel for any height that a projector has. Beyond the reach the rays of one stage angle fold (caustics): a
/// point has up to four rays, or none. These rows are filled ray by ray, which keeps the power; there the climb is that
/// of low rays.
class RayTable {
 public:
  struct Zone {
    double first_mm = 0;  // radius of row 0
    double pitch_mm = 0;
    int rows = 0;
    int sheets = 1;  // branches of the map
    std::size_t offset = 0;
  };

  struct Setup {
    optics::View view;
    int angles = 0;  // stage angles of one turn
    int sense = 1;   // +1 when alpha grows with the index
    double absorption_per_mm = 0;
    double r_max_mm = 0;   // radii up to this are needed
    double pitch_mm = 0;   // of the rows
    double height_mm = 0;  // largest |z| above or below the lens's axis that is needed
  };
  explicit RayTable(const Setup& setup);

  /// The nodes at that height. Levels: the rays do not climb, and every height has the same columns.
  void at_height(double z_mm, RayNodes& nodes) const;
  [[nodiscard]] bool climbs() const { return climbs_; }
  /// Largest change of x_p, in mm of the image plane, from one height to another.
  [[nodiscard]] double drift_mm(double from_mm, double to_mm) const;

  /// alpha = sense * (i * phases + phase) * 2 pi / (angles * phases) is element i from series(zone, row, sheet, phase)
  /// on. The turn is stored twice, so that any `angles` consecutive elements can be read.
  [[nodiscard]] std::size_t series(const Zone& zone, int row, int sheet, int phase) const {
    return zone.offset +
           static_cast<std::size_t>((row * zone.sheets + sheet) * phases + phase) * static_cast<std::size_t>(length);
  }

  int angles = 0;
  int phases = 0;
  int length = 0;  // of a series: 2 * angles + 1
  double reach_mm = 0;
  double edge_mm = 0;  // radius of the resin
  Zone inner;          // to be interpolated between rows
  Zone outer;          // nearest row

 private:
  struct Light;
  /// Coefficients of 1, z^2 and z^4.
  using Even = std::array<float, 3>;
  struct Node {
    Even x_p{}, row{1}, strength{}, spacing{1};  // z_p = z * row(z^2)
    float cosine = 1, sine = 0;
  };
  void fill_inner_row(const Light& light, int row);
  void fill_outer_row(const Light& light, int row);
  [[nodiscard]] std::size_t node(const Zone& zone, int row, int sheet, int index) const {
    const std::size_t before = zone.offset / static_cast<std::size_t>(length);
    return (before + static_cast<std::size_t>((row * zone.sheets + sheet) * phases)) *
               static_cast<std::size_t>(angles) +
           static_cast<std::size_t>(index);
  }

  Setup setup_;
  bool climbs_ = false;
  std::vector<Node> nodes_;  // [zone, row, sheet][index of alpha]
};

}  // namespace vam::light
