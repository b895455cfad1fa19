// SPDX-License-Identifier: GPL-3.0-or-later
#include "light/rays/private/posed_rays.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numbers>

#include "base/compute/parallel.hpp"
#include "base/constants.hpp"
#include "base/error.hpp"
#include "base/index.hpp"
#include "base/text/text.hpp"
#include "light/rays/private/chief_ray_dose.hpp"
#include "model/tolerances.hpp"

namespace vam::light {

namespace {

constexpr int fitted_directions = 360;
constexpr double rows_per_reach = 24;
constexpr float float_turn_rad = 2 * std::numbers::pi_v<float>;
using NodeValues = std::array<float, DisplacedVial::floats>;

/// The ray of the table as it is, where to begin.
FoundRay begin_at(const RayTable& table, double r_mm, double turn) {
  const int row = std::min(table.inner.rows - 1, round_int(r_mm / table.inner.pitch_mm));
  const int direction = round_int(turn * table.directions) % table.directions;
  const TableNode& node = table.points(table.inner, row, 0)[direction];
  return {.x_p_mm = static_cast<double>(node.x_p[0]), .row = static_cast<double>(node.row[0])};
}

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
  const double most = model::most_displacement_mm(resin_mm);
  if (largest_mm <= most) return;
  throw Error{Fault::data, "poses: the vial is displaced by " + format_number(largest_mm, 4) + " mm, at most " +
                               format_number(most, 4) + " mm supported; align the vial, or check the unit"};
}

}  // namespace

DisplacedVial::DisplacedVial(const RayTable::Scope& scope, const RayTable& table, double largest_mm)
    : largest_mm_(largest_mm) {
  const double inside = table.inner.pitch_mm * (table.inner.rows - 1);
  rows_ = std::max(2, ceil_int(inside / table.reach_mm * rows_per_reach) + 1);
  pitch_mm_ = inside / (rows_ - 1);
  points_.resize(static_cast<std::size_t>(rows_) * (fitted_directions + 1));
  parallel_for(rows_, [&](int row) {
    Change* to = points_.data() + std::ptrdiff_t{row} * (fitted_directions + 1);
    for (int i = 0; i < fitted_directions; ++i) to[i] = fit(scope, table, row, i);
    to[fitted_directions] = to[0];
  });
}

/// The vial in its place and at five places around it, 72 degrees apart: as many as a polynomial of second degree has
/// coefficients, which are the harmonics 0, 1 and 2 of the circle.
DisplacedVial::Change DisplacedVial::fit(const RayTable::Scope& scope, const RayTable& table, int row,
                                         int direction) const {
  constexpr int places = 5;
  const ChiefRayDose light{scope, table.edge_mm, table.reach_mm};
  const double r = row * pitch_mm_;
  const double turn = static_cast<double>(direction) / fitted_directions;
  const double x = r * std::cos(scope.sense * turn * turn_rad);
  const double y = r * std::sin(scope.sense * turn * turn_rad);
  const FoundRay begin = begin_at(table, r, turn);
  const double low_mm = 0.01 * scope.height_mm;
  bool lit = true;
  const auto values = [&](const optics::Displacement& vial) {
    const FoundRay level = ray_at(light, x, y, low_mm, begin, vial);
    lit = lit && level.hits;
    return std::bit_cast<NodeValues>(table.climbs() ? node_over_heights(light, x, y, level, vial)
                                                    : node_of(level, level, level));
  };
  const NodeValues middle = values({});
  std::array<std::array<double, 5>, floats> harmonics{};  // mean, cos, sin, cos 2, sin 2
  for (int k = 0; k < places; ++k) {
    const double phi = turn_rad * k / places;
    const NodeValues there = values({largest_mm_ * std::cos(phi), largest_mm_ * std::sin(phi)});
    const std::array<double, 5> basis{0.5, std::cos(phi), std::sin(phi), std::cos(2 * phi), std::sin(2 * phi)};
    for (std::size_t v = 0; v < floats; ++v) {
      const double change = static_cast<double>(there[v]) - static_cast<double>(middle[v]);
      for (std::size_t h = 0; h < basis.size(); ++h) harmonics[v][h] += 2.0 / places * basis[h] * change;
    }
  }
  Change point{};
  if (!lit) return point;  // at the rim
  for (std::size_t v = 0; v < floats; ++v) {
    const auto& [mean, cosine, sine, cosine_2, sine_2] = harmonics[v];
    point[0][v] = static_cast<float>(cosine);
    point[1][v] = static_cast<float>(sine);
    point[2][v] = static_cast<float>(mean + cosine_2);
    point[3][v] = static_cast<float>(2 * sine_2);
    point[4][v] = static_cast<float>(mean - cosine_2);
  }
  return point;
}

DisplacedVial::Powers DisplacedVial::powers(const optics::Displacement& vial) const {
  const auto x = static_cast<float>(vial.x_mm / largest_mm_);
  const auto y = static_cast<float>(vial.y_mm / largest_mm_);
  return {x, y, x * x, x * y, y * y};
}

void DisplacedVial::add(float r_mm, float turn, const Powers& powers, std::array<float, floats>& node) const {
  const float place = std::min(r_mm / static_cast<float>(pitch_mm_), static_cast<float>(rows_ - 1));
  const int row = std::min(static_cast<int>(place), rows_ - 2);
  const float across = place - static_cast<float>(row);
  const float along = turn * fitted_directions;
  const int direction = std::min(static_cast<int>(along), fitted_directions - 1);
  const float part = along - static_cast<float>(direction);
  const Change* low = points_.data() + std::ptrdiff_t{row} * (fitted_directions + 1) + direction;
  const Change* high = low + fitted_directions + 1;
  for (std::size_t p = 0; p < powers.size(); ++p) {
    const float a = powers[p] * (1 - across) * (1 - part);
    const float b = powers[p] * (1 - across) * part;
    const float c = powers[p] * across * (1 - part);
    const float d = powers[p] * across * part;
    for (std::size_t v = 0; v < floats; ++v) {
      node[v] += a * low[0][p][v] + b * low[1][p][v] + c * high[0][p][v] + d * high[1][p][v];
    }
  }
}

std::shared_ptr<const DisplacedVial> RayTable::displaced(double largest_mm) const {
  const std::scoped_lock lock(guard_);
  auto& made = displaced_[largest_mm];
  if (!made) made = std::make_shared<const DisplacedVial>(scope_, *this, largest_mm);
  return made;
}

PosedRays::PosedRays(const VialSetup& setup, int sense, const RayTable& table) : sense_(sense) {
  const double largest_mm = model::farthest_mm(setup.poses, model::Moves::vial);
  require_small(largest_mm, table.edge_mm);
  if (largest_mm > 0) shift_ = table.displaced(largest_mm);
  for (std::size_t k = 0; k < setup.poses.size(); ++k) {
    const model::Pose& pose = setup.poses[k];
    const double theta = setup.part_angle_rad(static_cast<int>(k));
    FramePose& frame = frames_.emplace_back();
    frame.cosine = std::cos(theta);
    frame.sine = std::sin(theta);
    frame.lift_mm = pose.dz_mm;
    if (pose.dx_mm == 0 && pose.dy_mm == 0) continue;
    if (pose.moves == model::Moves::part) {
      frame.x_mm = pose.dx_mm;
      frame.y_mm = pose.dy_mm;
    } else {
      frame.shifted = true;
      frame.powers = shift_->powers({pose.dx_mm, pose.dy_mm});
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
    if (here.shifted) shift_->add(r, turn, here.powers, values);
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
