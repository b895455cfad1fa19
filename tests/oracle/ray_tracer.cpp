// SPDX-License-Identifier: GPL-3.0-or-later
#include "oracle/ray_tracer.hpp"

#include <cmath>

namespace vam::oracle {

namespace {

Real dot(const Vec& a, const Vec& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
Vec combine(Real p, const Vec& a, Real q, const Vec& b) {
  return {p * a[0] + q * b[0], p * a[1] + q * b[1], p * a[2] + q * b[2]};
}
Vec unit(const Vec& a) {
  const Real length = std::sqrt(dot(a, a));
  return {a[0] / length, a[1] / length, a[2] / length};
}

// Refracts at the ray's point; normal is a unit vector against the ray. Vector Snell: d' = r d + (r c - c') n, r =
// n1/n2.
std::optional<Ray> refract(const Ray& ray, const Vec& normal, Real n1, Real n2) {
  const Real r = n1 / n2;
  const Real c1 = -dot(ray.direction, normal);
  const Real rest = 1 - r * r * (1 - c1 * c1);
  if (rest < 0) return std::nullopt;
  const Real c2 = std::sqrt(rest);
  const Real across = (n1 * c1 - n2 * c2) / (n1 * c1 + n2 * c2);
  const Real along = (n2 * c1 - n1 * c2) / (n2 * c1 + n1 * c2);
  Ray out = ray;
  out.direction = unit(combine(r, ray.direction, r * c1 - c2, normal));
  out.transmittance *= 1 - (across * across + along * along) / 2;
  return out;
}

// Nearest crossing of the cylinder around the vertical through (x, y) from outside.
std::optional<Ray> enter(const Ray& ray, const Cylinder& cylinder, Real n_outside, Real x, Real y) {
  const Vec p{ray.point[0] - x, ray.point[1] - y, ray.point[2]};
  const Vec& d = ray.direction;
  const Real a = d[0] * d[0] + d[1] * d[1];
  const Real b = p[0] * d[0] + p[1] * d[1];
  const Real c = p[0] * p[0] + p[1] * p[1] - cylinder.radius * cylinder.radius;
  const Real square = b * b - a * c;
  if (square < 0) return std::nullopt;
  Ray at = ray;
  at.point = combine(1, ray.point, (-b - std::sqrt(square)) / a, d);
  return refract(at, unit({at.point[0] - x, at.point[1] - y, 0}), n_outside, cylinder.index);
}

}  // namespace

std::optional<Ray> trace(const Bench& bench, Real x, Real z) {
  const Vec target{x, 0, z};
  std::optional<Ray> ray = Ray{};
  if (bench.lens_distance) {
    ray->point = {0, -*bench.lens_distance, 0};
    ray->direction = unit(combine(1, target, -1, ray->point));
  } else {
    ray->direction = {0, 1, 0};
    Real far = bench.window;
    for (const Cylinder& cylinder : bench.cylinders) far += 2 * cylinder.radius;
    ray->point = combine(1, target, -far, ray->direction);
  }
  if (bench.window > 0) {
    const Real steps = (-bench.window - ray->point[1]) / ray->direction[1];
    ray->point = combine(1, ray->point, steps, ray->direction);
    ray = refract(*ray, {0, -1, 0}, 1, bench.bath);
  }
  Real outside = bench.bath;
  for (const Cylinder& cylinder : bench.cylinders) {
    if (ray) ray = enter(*ray, cylinder, outside, bench.axis_x, bench.axis_y);
    outside = cylinder.index;
  }
  return ray;
}

Line line_of(const Ray& ray) {
  // The direction is (-sin a, cos a) up to its length; t is the offset along (cos a, sin a).
  const Real a = std::atan2(-ray.direction[0], ray.direction[1]);
  return {ray.point[0] * std::cos(a) + ray.point[1] * std::sin(a), a};
}

}  // namespace vam::oracle
