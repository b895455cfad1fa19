// SPDX-License-Identifier: GPL-3.0-or-later
#include "light/rays/private/ray_table.hpp"

#include <algorithm>
#include <cmath>

#include "base/compute/parallel.hpp"
#include "base/constants.hpp"
#include "base/index.hpp"
#include "light/rays/private/chief_ray_dose.hpp"
#include "optics/writable_radius.hpp"

namespace vam::light {

namespace {

constexpr int least_directions = 1440;  // alpha in steps of at most 0.25 deg: column to 1e-3 at 400 columns radius

/// Directions are even in number: one half of them mirrors the other.
int phases_of(int angles) {
  const int least = (least_directions + angles - 1) / angles;
  return least + least * angles % 2;
}

float value(const TableNode::Even& even, float z2) { return even[0] + z2 * (even[1] + z2 * even[2]); }

}  // namespace

RayTable::RayTable(const Scope& scope)
    : phases(phases_of(scope.angles)),
      directions(scope.angles * phases),
      reach_mm(optics::reach_mm(scope.view)),
      edge_mm(optics::resin_radius_mm(scope.view)),
      scope_(scope),
      climbs_(scope.view.rows_lens_mm.has_value()) {
  const ChiefRayDose light{scope_, edge_mm, reach_mm};
  const double pitch_mm = climbs_ ? scope.voxel_mm : 0.5 * scope.voxel_mm;
  const double inside = std::min(reach_mm * (climbs_ ? 0.9995 : optics::rim), std::max(scope.r_max_mm, pitch_mm));
  inner.rows = std::max(2, ceil_int(inside / pitch_mm) + 1);
  inner.pitch_mm = inside / (inner.rows - 1);
  inner_edge_mm = std::max(inside, std::min(reach_mm, scope.r_max_mm));
  // With level rays no voxel of the inner zone is crossed by the reach; climbing ones need its heights.
  const double inner_end = climbs_ ? reach_mm : std::max(0.0, reach_mm - 0.5 * scope.voxel_mm);
  const double beyond = std::min(edge_mm, scope.r_max_mm) - inner_end;
  if (beyond > 0) {
    inner_edge_mm = inner_end;
    outer.sheets = most_sheets;
    outer.rows = ceil_int(circles_per_voxel * beyond / scope.voxel_mm);
    outer.pitch_mm = beyond / outer.rows;
    outer.first_mm = inner_edge_mm + 0.5 * outer.pitch_mm;
    outer.first_row = inner.rows;
  }
  for (int i = 0; i < directions; ++i) {
    const double alpha = scope.sense * i * turn_rad / directions;
    cosines_.push_back(static_cast<float>(std::cos(alpha)));
    sines_.push_back(static_cast<float>(std::sin(alpha)));
  }
  nodes_.resize(static_cast<std::size_t>(inner.rows + outer.rows * outer.sheets) * directions);
  parallel_for(inner.rows, [&](int row) { fill_inner_row(light, row); });
  constexpr int rows_at_once = 16;  // their circles overlap
  parallel_for((outer.rows + rows_at_once - 1) / rows_at_once, [&](int block) {
    fill_outer_rows(light, block * rows_at_once, std::min((block + 1) * rows_at_once, outer.rows));
  });
  for (int row = 0; row < outer.rows; ++row) continue_outer_row(row);
}

std::shared_ptr<const RayTable> RayTable::of(const Scope& scope) {
  static std::mutex guard;
  static std::vector<std::weak_ptr<const RayTable>> all;
  const std::scoped_lock lock(guard);
  std::erase_if(all, [](const auto& table) { return table.expired(); });
  for (const auto& one : all) {
    if (const auto table = one.lock(); table && table->scope_ == scope) return table;
  }
  auto made = std::make_shared<const RayTable>(scope);
  all.push_back(made);
  return made;
}

RayTable::RowPair RayTable::Zone::rows_at(double r_mm) const {
  const double place = std::clamp((r_mm - first_mm) / pitch_mm, 0.0, rows - 1.0);
  const int low = floor_int(place);
  return {low, std::min(low + 1, rows - 1), static_cast<float>(place - low)};
}

HeightScale RayTable::scale_at(double z_mm, const RayScale& scale) const {
  return {static_cast<float>((z_mm / scope_.height_mm) * (z_mm / scope_.height_mm)),
          static_cast<float>(scale.columns_per_mm),
          static_cast<float>(scale.column_origin),
          static_cast<float>(scale.rows_per_mm * z_mm),
          static_cast<float>(scale.row_origin),
          static_cast<float>(scale.rows_per_slice),
          static_cast<float>(scale.columns_per_voxel)};
}

void RayTable::at_height(double z_mm, const RayScale& scale, const LightSpread& spread, RayNodes& nodes) const {
  const int rows = inner.rows + outer.rows * outer.sheets;
  nodes.resize(rows * static_cast<std::size_t>(directions + 1));
  const HeightScale here = scale_at(z_mm, scale);
  parallel_for(rows, [&](int row) {
    const TableNode* from = nodes_.data() + std::ptrdiff_t{row} * directions;
    RayNode* to = nodes.data() + std::ptrdiff_t{row} * (directions + 1);
    const int circle = row - outer.first_row;
    const auto r = static_cast<float>(
        circle < 0 || outer.rows == 0 ? row * inner.pitch_mm : outer.first_mm + circle / outer.sheets * outer.pitch_mm);
    for (int i = 0; i < directions; ++i) {
      to[i] = node_at(from[i], here, spread, r * cosines_[i], r * sines_[i]);
    }
    to[directions] = to[0];
  });
}

double RayTable::spread_along_mm(double x_mm, double y_mm, const LightSpread& spread) const {
  const int row = std::min(round_int(std::hypot(x_mm, y_mm) / inner.pitch_mm), inner.rows - 1);
  const double turn = scope_.sense * std::atan2(y_mm, x_mm) / turn_rad;
  const int direction = round_int((turn - std::floor(turn)) * directions) % directions;
  const TableNode& node = nodes_[static_cast<std::size_t>(row) * directions + direction];
  const float depth = depth_mm(node, static_cast<float>(x_mm), static_cast<float>(y_mm));
  return static_cast<double>(spread.along_mm(node.x_p[0], depth) * node.row[0]);
}

double RayTable::drift_mm(double from_mm, double to_mm, double r_mm) const {
  const auto square = [&](double z) { return static_cast<float>((z / scope_.height_mm) * (z / scope_.height_mm)); };
  constexpr double counts = 0.95;  // of the reach: at the rim rays drift without bounds, and carry next to nothing
  const int row = std::min(inner.rows - 1, ceil_int(std::min(r_mm, counts * reach_mm) / inner.pitch_mm));
  const TableNode* nodes = nodes_.data() + std::ptrdiff_t{row} * directions;
  float most = 0;
  for (int i = 0; i < directions; ++i) {
    const TableNode::Even& x_p = nodes[i].x_p;
    most = std::max(most, std::abs(value(x_p, square(to_mm)) - value(x_p, square(from_mm))));
  }
  return most;
}

}  // namespace vam::light
