// Rows of the table within the reach: every point has one ray from each side.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "light/private/level_rays.hpp"
#include "light/private/ray_table.hpp"
#include "optics/skew_ray.hpp"

namespace vam::light {

namespace {

constexpr double middle_height = 0.6;  // of the largest: where the polynomials are exact besides 0 and 1

/// The ray through a point, at one height.
struct Found {
  double x_p_mm, row, strength, spacing;
};

/// The level ray that has direction alpha at radius r; b is where to begin, and where it was found. alpha(b) is
/// monotone here: a few steps. Halving guards the rim, where delta is steepest.
LevelRays::Point level_ray(const LevelRays& light, double r_mm, double alpha, double& b) {
  LevelRays::Point point = light.at(r_mm, b);
  for (int step = 0; step < 60 && std::abs(alpha - point.alpha) > 1e-12; ++step) {
    const double limit = 0.25 / (1 + step);
    b += std::clamp((alpha - point.alpha) / point.alpha_rate, -limit, limit);
    point = light.at(r_mm, b);
  }
  return point;
}

/// The ray at height z. At the rim, where level rays still pass, those that climb may not: there they carry nothing.
Found ray_at(const LevelRays& light, double x_mm, double y_mm, double z_mm, const Found& level) {
  const optics::RayAt found = optics::ray_through(light.setup.view, x_mm, y_mm, z_mm, level.x_p_mm, z_mm * level.row);
  const optics::SkewRay& ray = found.ray;
  if (!ray.hits) return {level.x_p_mm, level.row, 0, level.spacing};
  const double u = y_mm * std::cos(ray.delta_rad) - x_mm * std::sin(ray.delta_rad);
  return {found.x_p_mm, found.z_p_mm / z_mm,
          ray.transmittance * found.density * light.transmitted(ray.offset_mm, u, ray.steepness()),
          light.spacing(found.spacing)};
}

/// The polynomial in z^2 that takes these values at z = 0, middle_height and 1 (in units of the largest height).
TableNode::Even even_fit(double at_0, double at_middle, double at_1) {
  constexpr double m = middle_height * middle_height;
  const double a = (at_middle - at_0) / m;  // c1 + c2 m
  const double b = at_1 - at_0;             // c1 + c2
  const double c2 = (b - a) / (1 - m);
  return {static_cast<float>(at_0), static_cast<float>(b - c2), static_cast<float>(c2)};
}

TableNode node_of(const optics::ChiefRay& ray, const Found& level, const Found& middle, const Found& top) {
  return {even_fit(level.x_p_mm, middle.x_p_mm, top.x_p_mm),
          even_fit(level.row, middle.row, top.row),
          even_fit(level.strength, middle.strength, top.strength),
          even_fit(level.spacing, middle.spacing, top.spacing),
          static_cast<float>(std::cos(ray.delta_rad)),
          static_cast<float>(std::sin(ray.delta_rad))};
}

}  // namespace

void RayTable::fill_inner_row(const LevelRays& light, int row) {
  const double r = row * inner.pitch_mm;
  double b = 0;
  for (int index = 0; index < directions; ++index) {
    const double alpha = setup_.sense * index * (2 * std::numbers::pi) / directions;
    const LevelRays::Point point = level_ray(light, r, alpha, b);
    const double zoom = climbs_ ? light.low_zoom(point.x_p_mm, point.u_mm) : 1;
    const Found level{point.x_p_mm, zoom, point.strength / point.alpha_rate * zoom,
                      light.spacing(1 / (point.ray.jacobian * point.alpha_rate))};
    Found middle = level;
    Found top = level;
    if (climbs_) {
      const double x = r * std::cos(alpha);
      const double y = r * std::sin(alpha);
      middle = ray_at(light, x, y, setup_.height_mm * middle_height, level);
      top = ray_at(light, x, y, setup_.height_mm, level);
    }
    row_of(inner, row, 0)[index] = node_of(point.ray, level, middle, top);
  }
}

}  // namespace vam::light
