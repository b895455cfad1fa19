// SPDX-License-Identifier: GPL-3.0-or-later
// Rows of the ray table beyond the writable radius, where rays fold into caustics: rays are counted, which conserves
// the power, and a node is their mean over a voxel [physics §4].
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "base/constants.hpp"
#include "base/index.hpp"
#include "light/rays/private/chief_ray_dose.hpp"
#include "light/rays/private/ray_table.hpp"

namespace vam::light {

namespace {

constexpr int samples_per_step = 8;  // rays per step of alpha where the map folds

/// What was counted for a direction: sums over rays, weighted by their strength.
struct Cell {
  double strength = 0;
  double x_p = 0, x_p2 = 0, zoom = 0, cosine = 0, sine = 0;

  void add(const Cell& other, double share) {
    strength += share * other.strength;
    x_p += share * other.x_p;
    x_p2 += share * other.x_p2;
    zoom += share * other.zoom;
    cosine += share * other.cosine;
    sine += share * other.sine;
  }
};
using RaySheet = std::vector<Cell>;  // [direction]
using Circle = std::array<RaySheet, RayTable::most_sheets>;

/// Counts the rays that cross a circle.
class RayCount {
 public:
  RayCount(const ChiefRayDose& light, int directions, bool climbs)
      : light_(light), directions_(directions), climbs_(climbs) {}

  /// They have |t| = r |cos b| within the reach.
  [[nodiscard]] Circle on(double r_mm) const {
    Circle circle;
    circle.fill(RaySheet(directions_));
    if (r_mm >= light_.edge_mm) return circle;
    const double open = std::acos(std::min(1.0, optics::rim * light_.reach_mm / r_mm));
    count_side(r_mm, -std::numbers::pi + open, std::numbers::pi - 2 * open, 0, circle);  // light enters at u < 0
    count_side(r_mm, open, std::numbers::pi - 2 * open, 1, circle);
    return circle;
  }

 private:
  /// Rays at equal steps of b from one side, the sheet one further after every fold.
  void count_side(double r_mm, double first_rad, double arc_rad, int sheet, Circle& circle) const {
    const int samples = std::max(8, ceil_int(samples_per_step * directions_ * arc_rad / turn_rad));
    const double step = arc_rad / samples;
    bool rising = true;
    for (int k = 0; k < samples; ++k) {
      const ChiefRayDose::OnCircle point = light_.at(r_mm, first_rad + (k + 0.5) * step);
      if (k == 0) rising = point.alpha_rate > 0;
      if ((point.alpha_rate > 0) != rising) {
        rising = !rising;
        sheet = std::min(sheet + 1, RayTable::most_sheets - 1);
      }
      count(point, step, circle[sheet]);
    }
  }

  /// Shared by the two directions nearest to the ray's own.
  void count(const ChiefRayDose::OnCircle& point, double step_rad, RaySheet& sheet) const {
    const double zoom = climbs_ ? light_.low_zoom(point.x_p_mm, point.u_mm) : 1.0;
    const double steps_per_rad = directions_ / turn_rad;
    const double strength = point.strength * zoom * step_rad * steps_per_rad;
    const double x_p = point.x_p_mm;
    const Cell ray{strength,
                   strength * x_p,
                   strength * x_p * x_p,
                   strength * zoom,
                   strength * std::cos(point.ray.delta_rad),
                   strength * std::sin(point.ray.delta_rad)};
    const double place = light_.scope.sense * point.alpha * steps_per_rad;
    const double below = std::floor(place);
    for (const int side : {0, 1}) {
      const int index = (static_cast<int>(below) + side) % directions_;
      sheet[(index + directions_) % directions_].add(ray, side == 1 ? place - below : 1 - (place - below));
    }
  }

  const ChiefRayDose& light_;
  int directions_;
  bool climbs_;
};

/// Sum over a box of directions, `width` in steps of the table, at least 1.
Cell box_sum(const RaySheet& sheet, int index, double width) {
  const auto directions = count_of(sheet);
  const double half = 0.5 * (width - 1);  // on either side of the cell in the middle
  const int whole = floor_int(half);
  Cell sum;
  for (int side = -whole - 1; side <= whole + 1; ++side) {
    sum.add(sheet[(index + side + directions) % directions], std::abs(side) <= whole ? 1 : half - whole);
  }
  return sum;
}

/// The mean ray of a cell of so many circles and steps, `weight`. The shadow of a voxel on the columns has the variance
/// of theirs, 1/12 of the square of its edge, which holds for a square however it is turned.
TableNode mean_of(const Cell& cell, double weight, double voxel_mm, double widest) {
  const auto mean = [&](double sum) { return static_cast<float>(sum / cell.strength); };
  const double x_p = cell.x_p / cell.strength;
  const double variance = std::max(0.0, cell.x_p2 / cell.strength - x_p * x_p);
  const double spacing = std::clamp(std::sqrt(12 * variance) / voxel_mm, 0.01 * widest, widest);
  return {
      {static_cast<float>(x_p), 0, 0},     {mean(cell.zoom), 0, 0}, {static_cast<float>(cell.strength / weight), 0, 0},
      {static_cast<float>(spacing), 0, 0}, mean(cell.cosine),       mean(cell.sine)};
}

}  // namespace

void RayTable::fill_outer_rows(const ChiefRayDose& light, int first, int end) {
  const RayCount rays(light, directions, climbs_);
  const double widest = light.spacing(std::numeric_limits<double>::infinity());
  const auto radius_mm = [&](double row) { return outer.first_mm + row * outer.pitch_mm; };
  std::vector<Circle> circles;
  for (int k = 0; k < end - first + circles_per_voxel - 1; ++k) {
    circles.push_back(rays.on(radius_mm(first + k - 0.5 * (circles_per_voxel - 1))));
  }
  for (int row = first; row < end; ++row) {
    // The cells' shares and the interpolation between nodes spread light by one step of the table each.
    const double steps = std::min(1.0, scope_.voxel_mm / radius_mm(row) / turn_rad) * directions;
    const double width = std::sqrt(std::max(1.0, steps * steps - 4));
    for (int sheet = 0; sheet < most_sheets; ++sheet) {
      RaySheet sum(directions);
      for (int k = 0; k < circles_per_voxel; ++k) {
        const RaySheet& from = circles[row - first + k][sheet];
        for (int index = 0; index < directions; ++index) sum[index].add(from[index], 1);
      }
      TableNode* to = row_of(outer, row, sheet);
      for (int index = 0; index < directions; ++index) {
        const Cell cell = box_sum(sum, index, width);
        to[index] = cell.strength > 0 ? mean_of(cell, width * circles_per_voxel, scope_.voxel_mm, widest) : TableNode{};
      }
    }
  }
}

/// Directions without a ray get the columns of a neighbour, so that interpolation to them only fades.
void RayTable::continue_outer_row(int row) {
  for (int sheet = 0; sheet < most_sheets; ++sheet) {
    TableNode* nodes = row_of(outer, row, sheet);
    const auto take = [&](int index, int other_row, int from) {
      if (other_row < 0 || other_row >= outer.rows) return false;
      const TableNode& other = row_of(outer, other_row, sheet)[(from + directions) % directions];
      if (!(other.strength[0] > 0)) return false;
      nodes[index] = other;
      nodes[index].strength = {};
      return true;
    };
    for (int index = 0; index < directions; ++index) {
      if (nodes[index].strength[0] > 0) continue;
      take(index, row, index - 1) || take(index, row, index + 1) || take(index, row - 1, index) ||
          take(index, row + 1, index);
    }
  }
}

}  // namespace vam::light
