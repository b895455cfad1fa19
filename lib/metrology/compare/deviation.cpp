// SPDX-License-Identifier: GPL-3.0-or-later
#include "metrology/compare/deviation.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "base/error.hpp"
#include "base/stats/curve_fit.hpp"
#include "base/text/json.hpp"
#include "solid/mesh/geometry.hpp"

namespace vam::metrology {

namespace {

// Quantile by linear interpolation between order statistics; the values are reordered. `from`: where an earlier call
// for a smaller part left off.
double quantile(std::vector<double>& values, double part, std::size_t* from = nullptr) {
  const double at = part * static_cast<double>(values.size() - 1);
  const auto low = static_cast<std::ptrdiff_t>(at);
  const auto begin = values.begin() + static_cast<std::ptrdiff_t>(from == nullptr ? 0 : *from);
  std::nth_element(begin, values.begin() + low, values.end());
  if (from != nullptr) *from = static_cast<std::size_t>(low);
  const double here = values[static_cast<std::size_t>(low)];
  if (low + 1 == std::ssize(values)) return here;
  return here + (at - static_cast<double>(low)) * (*std::min_element(values.begin() + low + 1, values.end()) - here);
}

Json to_json(const SurfaceDeviation& d, double size_mm) {
  Json json{{"samples", d.samples},
            {"rms_mm", d.rms_mm},
            {"rms_percent", 100 * d.rms_mm / size_mm},
            {"mean_mm", d.mean_mm},
            {"sigma_mm", d.sigma_mm},
            {"mad_mm", d.mad_mm},
            {"trimmed_rms_mm", d.trimmed_mm},
            {"min_mm", d.min_mm},
            {"max_mm", d.max_mm},
            {"max_abs_mm", d.max_abs_mm},
            {"max_abs_percent", 100 * d.max_abs_mm / size_mm}};
  for (const auto& [percent, mm] : d.percentiles_mm) json["p" + std::to_string(static_cast<int>(percent)) + "_mm"] = mm;
  return json;
}

}  // namespace

SurfaceDeviation deviation(std::span<const float> distances_mm) {
  if (distances_mm.empty()) throw Error{Fault::data, "no surface to measure: the print has no area"};
  std::vector<double> values(distances_mm.begin(), distances_mm.end());
  SurfaceDeviation d;
  d.samples = values.size();
  const auto n = static_cast<double>(values.size());
  for (const double x : values) {
    d.mean_mm += x / n;
    d.rms_mm += x * x / n;
  }
  for (const double x : values) d.sigma_mm += (x - d.mean_mm) * (x - d.mean_mm) / n;
  d.rms_mm = std::sqrt(d.rms_mm);
  d.sigma_mm = std::sqrt(d.sigma_mm);
  std::size_t place = 0;
  for (const double percent : {1.0, 5.0, 25.0, 50.0, 75.0, 95.0, 99.0}) {
    d.percentiles_mm.emplace_back(percent, quantile(values, percent / 100, &place));
  }
  const double median = d.percentiles_mm[3].second;
  const auto [least, most] = std::minmax_element(values.begin(), values.end());
  d.min_mm = *least;
  d.max_mm = *most;
  d.max_abs_mm = std::max(std::abs(d.min_mm), std::abs(d.max_mm));
  std::vector<double> sizes = values;
  for (double& x : sizes) x = std::abs(x);
  constexpr double kept = 0.95;
  const auto near = std::max<std::ptrdiff_t>(1, static_cast<std::ptrdiff_t>(kept * n));
  std::nth_element(sizes.begin(), sizes.begin() + near - 1, sizes.end());
  for (std::ptrdiff_t i = 0; i < near; ++i) d.trimmed_mm += sizes[i] * sizes[i] / static_cast<double>(near);
  d.trimmed_mm = std::sqrt(d.trimmed_mm);
  for (double& x : values) x = std::abs(x - median);
  d.mad_mm = quantile(values, 0.5);
  return d;
}

double within_percent(std::span<const float> distances_mm, double tolerance_mm) {
  if (distances_mm.empty()) return 0;
  const auto count = std::count_if(distances_mm.begin(), distances_mm.end(),
                                   [&](float d) { return std::abs(static_cast<double>(d)) <= tolerance_mm; });
  return 100 * static_cast<double>(count) / static_cast<double>(distances_mm.size());
}

std::array<double, 3> axis_shrinkage_percent(std::span<const solid::SurfaceSample> design,
                                             std::span<const float> distances_mm) {
  constexpr std::size_t unknowns = 9;  // growth and shift along each axis, turn about each
  constexpr std::size_t turns = 6;     // the first of these
  constexpr int rounds = 15;           // of reweighted least squares, to the least sum of absolute misses
  constexpr double least_mm = 1e-5;    // what a miss is divided by at least
  constexpr double least_grip = 1e-6;  // of all weights, that holds a turn in which a surface slides on itself
  Vector3 middle{};
  for (const auto& s : design) middle = middle + (1.0 / static_cast<double>(design.size())) * s.point;
  const auto row_of = [&](std::size_t i) {
    const Vector3& n = design[i].normal;
    const Vector3 arm = design[i].point - middle;
    const Vector3 turn = cross(arm, n);
    return std::array<double, unknowns>{n[0] * arm[0], n[1] * arm[1], n[2] * arm[2], n[0],   n[1],
                                        n[2],          turn[0],       turn[1],       turn[2]};
  };
  double reach_mm = 1e-12;
  for (const auto& s : design) reach_mm = std::max(reach_mm, length(s.point - middle));
  std::vector<double> part(unknowns);
  std::vector<double> weight(design.size(), 1.0);
  for (int round = 0; round < rounds; ++round) {
    std::vector<double> rows;
    std::vector<double> values;
    for (std::size_t i = 0; i < design.size(); ++i) {
      const double root = std::sqrt(weight[i]);
      for (const double r : row_of(i)) rows.push_back(root * r);
      values.push_back(root * static_cast<double>(distances_mm[i]));
    }
    const double held = reach_mm * std::sqrt(least_grip * std::accumulate(weight.begin(), weight.end(), 0.0));
    for (std::size_t turn = turns; turn < unknowns; ++turn) {
      for (std::size_t column = 0; column < unknowns; ++column) rows.push_back(column == turn ? held : 0.0);
      values.push_back(0);
    }
    part = stats::linear_fit(rows, unknowns, values);
    for (std::size_t i = 0; i < design.size(); ++i) {
      const auto row = row_of(i);
      const double fitted = std::inner_product(row.begin(), row.end(), part.begin(), 0.0);
      weight[i] = 1 / std::max(std::abs(static_cast<double>(distances_mm[i]) - fitted), least_mm);
    }
  }
  return {-100 * part[0], -100 * part[1], -100 * part[2]};
}

Distances measure(const model::TriangleSoup& print, const model::TriangleSoup& design_mesh,
                  const solid::Surface& design, int samples) {
  const auto points_of = [](const std::vector<solid::SurfaceSample>& places) {
    std::vector<Vector3> points;
    for (const auto& place : places) points.push_back(place.point);
    return points;
  };
  Distances found;
  found.largest_dimension_mm = solid::bounding_box(design_mesh).largest_side();
  found.on_print = solid::sample_surface(print, samples);
  found.print_mm = design.signed_distances(points_of(found.on_print));
  if (found.print_mm.empty()) throw Error{Fault::data, "no surface to measure: the print has no area"};
  found.on_design = solid::sample_surface(design_mesh, samples);
  found.design_mm = solid::Surface(print).signed_distances(points_of(found.on_design));
  for (float& distance : found.design_mm) distance = -distance;
  return found;
}

Comparison compare(const Distances& distances) {
  Comparison result;
  result.largest_dimension_mm = distances.largest_dimension_mm;
  result.print_to_design = deviation(distances.print_mm);
  result.design_to_print = deviation(distances.design_mm);
  result.shrinkage_percent = axis_shrinkage_percent(distances.on_design, distances.design_mm);
  result.hausdorff_mm = std::max(result.print_to_design.max_abs_mm, result.design_to_print.max_abs_mm);
  return result;
}

std::array<std::uint8_t, 3> blue_white_red(double distance_mm, double limit_mm) {
  const double at = std::clamp(distance_mm / limit_mm, -1.0, 1.0);
  const auto pale = static_cast<std::uint8_t>(std::lround(255 * (1 - std::abs(at))));
  return at < 0 ? std::array<std::uint8_t, 3>{pale, pale, 255} : std::array<std::uint8_t, 3>{255, pale, pale};
}

Json to_json(const Comparison& comparison) {
  const double size = comparison.largest_dimension_mm;
  return {{"largest_dimension_mm", size},
          {"hausdorff_mm", comparison.hausdorff_mm},
          {"hausdorff_percent", 100 * comparison.hausdorff_mm / size},
          {"shrinkage_xyz_percent", comparison.shrinkage_percent},
          {"print_to_design", to_json(comparison.print_to_design, size)},
          {"design_to_print", to_json(comparison.design_to_print, size)}};
}

}  // namespace vam::metrology
