// SPDX-License-Identifier: GPL-3.0-or-later
#include "light/rays/private/displaced_vial.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

#include "base/compute/parallel.hpp"
#include "base/constants.hpp"
#include "base/index.hpp"
#include "light/rays/private/skew_ray_dose.hpp"

namespace vam::light {

namespace {

constexpr int fitted_directions = 360;
constexpr double rows_per_reach = 24;

using NodeValues = std::array<float, DisplacedVial::floats>;

/// The ray of the table as it is, where to begin.
FoundRay begin_at(const RayTable& table, double r_mm, double turn) {
  const int row = std::min(table.inner.rows - 1, round_int(r_mm / table.inner.pitch_mm));
  const int direction = round_int(turn * table.directions) % table.directions;
  const TableNode& node = table.points(table.inner, row, 0)[direction];
  FoundRay ray;
  ray.x_p_mm = static_cast<double>(node.x_p[0]);
  ray.row = static_cast<double>(node.row[0]);
  return ray;
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

}  // namespace vam::light
