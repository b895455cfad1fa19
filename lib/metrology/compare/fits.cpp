// SPDX-License-Identifier: GPL-3.0-or-later
#include "metrology/compare/fits.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "base/stats/curve_fit.hpp"

namespace vam::metrology {

namespace {

Vector3 middle_of(std::span<const Vector3> points) {
  Vector3 sum{};
  for (const Vector3& p : points) sum = sum + p;
  return (1.0 / static_cast<double>(points.size())) * sum;
}

Vector3 unit(const Vector3& v) { return (1 / length(v)) * v; }

double spread(const std::vector<double>& values) {
  const auto [least, most] = std::minmax_element(values.begin(), values.end());
  return *most - *least;
}

double share_perpendicular(std::span<const Vector3> normals, const Vector3& axis) {
  constexpr double sine = 0.174;  // of 10 degrees
  const auto count =
      std::count_if(normals.begin(), normals.end(), [&](const Vector3& n) { return std::abs(dot(n, axis)) < sine; });
  return static_cast<double>(count);
}

}  // namespace

AcrossAxis across(const Vector3& axis) {
  const Vector3 other = std::abs(axis[0]) < 0.6 ? Vector3{1, 0, 0} : Vector3{0, 1, 0};
  const Vector3 u = unit(other - dot(other, axis) * axis);
  return {u, cross(axis, u)};
}

PlaneFit fit_plane(std::span<const Vector3> points, const Vector3& near) {
  PlaneFit fit{middle_of(points), unit(near), 0};
  constexpr int rounds = 3;  // heights above a plane become distances from it
  for (int round = 0; round < rounds; ++round) {
    const AcrossAxis frame = across(fit.normal);
    std::vector<double> rows;
    std::vector<double> heights;
    for (const Vector3& p : points) {
      const Vector3 arm = p - fit.point;
      rows.insert(rows.end(), {dot(arm, frame.u), dot(arm, frame.v)});
      heights.push_back(dot(arm, fit.normal));
    }
    const std::vector<double> slope = stats::linear_fit(rows, 2, heights);
    fit.normal = unit(fit.normal - slope[0] * frame.u - slope[1] * frame.v);
  }
  std::vector<double> departures;
  for (const Vector3& p : points) departures.push_back(dot(p - fit.point, fit.normal));
  fit.peak_to_valley_mm = spread(departures);
  return fit;
}

CylinderFit fit_cylinder(std::span<const Vector3> points, const Vector3& near) {
  CylinderFit fit{middle_of(points), unit(near), 0, 0};
  for (const Vector3& p : points) {
    const Vector3 arm = p - fit.point;
    fit.radius_mm += length(arm - dot(arm, fit.axis) * fit.axis) / static_cast<double>(points.size());
  }
  std::vector<double> residuals(points.size());
  constexpr int rounds = 20;
  for (int round = 0; round < rounds; ++round) {
    const AcrossAxis frame = across(fit.axis);
    std::vector<double> rows;
    for (std::size_t i = 0; i < points.size(); ++i) {
      const Vector3 arm = points[i] - fit.point;
      const double x = dot(arm, frame.u);
      const double y = dot(arm, frame.v);
      const double z = dot(arm, fit.axis);
      const double r = std::max(std::hypot(x, y), 1e-12);
      residuals[i] = r - fit.radius_mm;
      rows.insert(rows.end(), {x / r, y / r, x / r * z, y / r * z, 1});
    }
    const std::vector<double> step = stats::linear_fit(rows, 5, residuals);
    fit.point = fit.point + step[0] * frame.u + step[1] * frame.v;
    fit.axis = unit(fit.axis + step[2] * frame.u + step[3] * frame.v);
    fit.radius_mm += step[4];
    if (std::hypot(step[0], step[1], step[4]) < 1e-9 * std::abs(fit.radius_mm)) break;
  }
  fit.peak_to_valley_mm = spread(residuals);
  return fit;
}

Vector3 axis_of(std::span<const Vector3> normals) {
  Vector3 best{0, 0, 1};
  double most = -1;
  const std::size_t every = std::max<std::size_t>(1, normals.size() / 40);
  for (std::size_t i = 0; i < normals.size(); i += every) {
    for (std::size_t j = i + every; j < normals.size(); j += every) {
      const Vector3 axis = cross(normals[i], normals[j]);
      if (length(axis) < 0.5) continue;
      const double share = share_perpendicular(normals, unit(axis));
      if (share > most) {
        most = share;
        best = unit(axis);
      }
    }
  }
  return best;
}

}  // namespace vam::metrology
