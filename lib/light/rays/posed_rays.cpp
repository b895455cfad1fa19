// SPDX-License-Identifier: GPL-3.0-or-later
#include "light/rays/private/posed_rays.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numbers>

#include "base/error.hpp"
#include "base/index.hpp"
#include "base/text/text.hpp"

namespace vam::light {

namespace {

constexpr float float_turn_rad = 2 * std::numbers::pi_v<float>;
using NodeValues = std::array<float, DisplacedVial::floats>;

/// Between four points of the table.
NodeValues between(const TableNode* low, const TableNode* high, float across, float along) {
  const auto a = std::bit_cast<NodeValues>(low[0]);
  const auto b = std::bit_cast<NodeValues>(low[1]);
  const auto c = std::bit_cast<NodeValues>(high[0]);
  const auto d = std::bit_cast<NodeValues>(high[1]);
  NodeValues values;
  for (std::size_t v = 0; v < values.size(); ++v) {
    const float first = a[v] + along * (b[v] - a[v]);
    const float second = c[v] + along * (d[v] - c[v]);
    values[v] = first + across * (second - first);
  }
  return values;
}

void require_small(double largest_mm, double resin_mm) {
  const double most = resin_mm / 12;  // there the polynomials err by some 0.03 columns
  if (largest_mm <= most) return;
  throw Error{Fault::data, "poses: the vial is displaced by " + format_number(largest_mm, 4) + " mm, at most " +
                               format_number(most, 4) + " mm supported; align the vial, or check the unit"};
}

}  // namespace

PosedRays::PosedRays(const VialSetup& setup, const RayTable::Scope& rays, const RayTable& table) : sense_(rays.sense) {
  const double largest_mm = model::farthest_mm(setup.poses, model::Moves::vial);
  require_small(largest_mm, table.edge_mm);
  if (largest_mm > 0) shift_ = DisplacedVial(rays, table, largest_mm);
  for (std::size_t k = 0; k < setup.poses.size(); ++k) {
    const model::Pose& pose = setup.poses[k];
    const double theta = setup.part_angle_rad(static_cast<int>(k));
    FramePose& frame = frames_.emplace_back();
    frame.cosine = std::cos(theta);
    frame.sine = std::sin(theta);
    frame.lift_mm = pose.dz_mm;
    const bool moved = pose.dx_mm != 0 || pose.dy_mm != 0;
    if (!moved) continue;
    if (pose.moves == model::Moves::part) {
      frame.x_mm = pose.dx_mm;
      frame.y_mm = pose.dy_mm;
    } else {
      frame.shifted = true;
      frame.powers = shift_.powers({pose.dx_mm, pose.dy_mm});
    }
  }
}

int PosedRays::find(const RayTable& table, double x_mm, double y_mm, int frame, const HeightScale& scale,
                    const LightSpread& spread, RayNode* to) const {
  const FramePose& here = frames_[frame];
  const auto x = static_cast<float>(x_mm * here.cosine + y_mm * here.sine + here.x_mm);
  const auto y = static_cast<float>(y_mm * here.cosine - x_mm * here.sine + here.y_mm);
  const float r = std::sqrt(x * x + y * y);
  if (r >= static_cast<float>(table.edge_mm)) return 0;
  const float turns = static_cast<float>(sense_) * std::atan2(y, x) / float_turn_rad;
  const float turn = turns < 0 ? turns + 1 : turns;
  const float place = turn * static_cast<float>(table.directions);
  const int direction = std::min(static_cast<int>(place), table.directions - 1);
  const float along = place - static_cast<float>(direction);
  const int next = direction + 1 < table.directions ? direction + 1 : 0;
  const auto pair = [&](const TableNode* points) { return std::array<TableNode, 2>{points[direction], points[next]}; };
  const auto node_of = [&](const RayTable::Zone& zone, int sheet) {
    const RayTable::RowPair rows = zone.rows_at(r);
    const auto low = pair(table.points(zone, rows.low, sheet));
    const auto high = pair(table.points(zone, rows.high, sheet));
    return between(low.data(), high.data(), rows.part, along);
  };
  if (r <= static_cast<float>(table.inner_edge_mm) || (here.shifted && r <= static_cast<float>(table.reach_mm))) {
    NodeValues values = node_of(table.inner, 0);
    if (here.shifted) shift_.add(r, turn, here.powers, values);
    to[0] = node_at(std::bit_cast<TableNode>(values), scale, spread, x, y);
    return 1;
  }
  if (table.outer.rows == 0 || here.shifted) return 0;
  for (int sheet = 0; sheet < table.outer.sheets; ++sheet) {
    to[sheet] = node_at(std::bit_cast<TableNode>(node_of(table.outer, sheet)), scale, spread, x, y);
  }
  return table.outer.sheets;
}

}  // namespace vam::light
