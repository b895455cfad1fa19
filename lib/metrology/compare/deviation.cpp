#include "metrology/compare/deviation.hpp"

#include <algorithm>
#include <cmath>

#include "base/error.hpp"
#include "base/json.hpp"

namespace vam::metrology {

namespace {

// Quantile by linear interpolation between order statistics; `sorted` ascending.
double quantile(const std::vector<double>& sorted, double part) {
  const double at = part * static_cast<double>(sorted.size() - 1);
  const auto low = static_cast<std::size_t>(at);
  const std::size_t high = std::min(low + 1, sorted.size() - 1);
  return sorted[low] + (at - static_cast<double>(low)) * (sorted[high] - sorted[low]);
}

Json to_json(const SurfaceDeviation& d, double size_mm) {
  Json json{{"samples", d.samples},
            {"rms_mm", d.rms_mm},
            {"rms_percent", 100 * d.rms_mm / size_mm},
            {"mean_mm", d.mean_mm},
            {"sigma_mm", d.sigma_mm},
            {"mad_mm", d.mad_mm},
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
  std::vector<double> sorted(distances_mm.begin(), distances_mm.end());
  std::sort(sorted.begin(), sorted.end());
  SurfaceDeviation d;
  d.samples = sorted.size();
  const auto n = static_cast<double>(sorted.size());
  for (const double x : sorted) {
    d.mean_mm += x / n;
    d.rms_mm += x * x / n;
  }
  for (const double x : sorted) d.sigma_mm += (x - d.mean_mm) * (x - d.mean_mm) / n;
  d.rms_mm = std::sqrt(d.rms_mm);
  d.sigma_mm = std::sqrt(d.sigma_mm);
  for (const double percent : {1.0, 5.0, 25.0, 50.0, 75.0, 95.0, 99.0}) {
    d.percentiles_mm.emplace_back(percent, quantile(sorted, percent / 100));
  }
  d.min_mm = sorted.front();
  d.max_mm = sorted.back();
  d.max_abs_mm = std::max(std::abs(d.min_mm), std::abs(d.max_mm));
  const double median = quantile(sorted, 0.5);
  for (double& x : sorted) x = std::abs(x - median);
  std::sort(sorted.begin(), sorted.end());
  d.mad_mm = quantile(sorted, 0.5);
  return d;
}

Comparison compare(const model::TriangleSoup& print, const model::TriangleSoup& design_mesh,
                   const solid::Surface& design, int samples) {
  const auto points_on = [samples](const model::TriangleSoup& mesh) {
    std::vector<Vector3> points;
    for (const auto& sample : solid::sample_surface(mesh, samples)) points.push_back(sample.point);
    return points;
  };
  Comparison result;
  result.largest_dimension_mm = solid::bounding_box(design_mesh).largest_side();
  result.samples_mm = design.signed_distances(points_on(print));
  result.print_to_design = deviation(result.samples_mm);
  std::vector<float> back = solid::Surface(print).signed_distances(points_on(design_mesh));
  for (float& distance : back) distance = -distance;
  result.design_to_print = deviation(back);
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
          {"print_to_design", to_json(comparison.print_to_design, size)},
          {"design_to_print", to_json(comparison.design_to_print, size)}};
}

}  // namespace vam::metrology
