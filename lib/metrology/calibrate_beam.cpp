#include "metrology/calibrate_beam.hpp"

#include <algorithm>
#include <cmath>

#include "base/constants.hpp"
#include "base/error.hpp"
#include "metrology/half_maximum.hpp"

namespace vam::metrology {

namespace {

// A straight line between two samples stands for the flank of a line that is only a few pixels wide: up to 0.01 px at
// either crossing for a Gaussian flank of 1.5 px.
constexpr double interpolation_px = 0.015;

}  // namespace

Measured line_width_px(const Image& picture, const std::string& subject) {
  constexpr int groups = 8;
  if (picture.height < 2 * groups) {
    throw Error{Fault::data, subject + ": " + std::to_string(picture.height) + " rows; at least " +
                                 std::to_string(2 * groups) + " are needed"};
  }
  double mean = 0;
  std::vector<double> widths;
  for (int g = 0; g < groups; ++g) {
    const auto extent =
        half_maximum(column_profile(picture, g * picture.height / groups, (g + 1) * picture.height / groups));
    if (!extent) {
      throw Error{Fault::data, subject + ": no bright line between two dark sides; light one column and focus"};
    }
    widths.push_back(extent->width());
    mean += extent->width() / groups;
  }
  double square = 0;
  for (const double width : widths) square += (width - mean) * (width - mean);
  const double error = std::sqrt(square / (groups - 1) / groups) * few_readings_factor(groups - 1);
  return {mean, std::hypot(error, interpolation_px), groups};
}

Beam measure_beam(const BeamWidths& widths) {
  const auto narrowest = std::min_element(widths.fwhm_mm.begin(), widths.fwhm_mm.end(),
                                          [](const Measured& a, const Measured& b) { return a.value < b.value; });
  if (widths.fwhm_mm.size() < 4) {
    throw Error{Fault::data, "beam: " + std::to_string(widths.fwhm_mm.size()) +
                                 " planes; at least 4 are needed, some before and "
                                 "some behind the focus"};
  }
  enum : std::size_t { waist, focus, growth };
  const auto model_mm = [](const std::vector<double>& p, double y_mm) {
    return std::hypot(p[waist], p[growth] * (y_mm - p[focus]));
  };
  const auto residuals = [&](const std::vector<double>& p) {
    std::vector<double> out;
    for (std::size_t i = 0; i < widths.plane_mm.size(); ++i) {
      out.push_back((widths.fwhm_mm[i].value - model_mm(p, widths.plane_mm[i])) / widths.fwhm_mm[i].sigma);
    }
    return out;
  };
  const double focus_mm = widths.plane_mm[static_cast<std::size_t>(narrowest - widths.fwhm_mm.begin())];
  double growth_start = 0;
  for (std::size_t i = 0; i < widths.plane_mm.size(); ++i) {
    const double away = std::abs(widths.plane_mm[i] - focus_mm);
    if (away > 0) growth_start = std::max(growth_start, (widths.fwhm_mm[i].value - narrowest->value) / away);
  }
  const double scale = narrowest->value;
  const auto fit = fit_curve(residuals, {scale, focus_mm, std::max(growth_start, 1e-4)}, {1e-4 * scale, 1e-3, 1e-6},
                             "beam: widths of " + std::to_string(widths.plane_mm.size()) + " planes");
  Beam beam{fit.measured(waist), fit.measured(focus), {}, fit.measured(growth)};
  beam.waist_mm.value = std::abs(beam.waist_mm.value);
  const double slope = std::abs(beam.divergence_deg.value);
  beam.divergence_deg.value = std::atan(slope) * deg_per_rad;
  beam.divergence_deg.sigma *= deg_per_rad / (1 + slope * slope);
  const auto& p = fit.value;
  const double width = model_mm(p, 0);
  beam.axis_fwhm_mm = fit.combined(
      {p[waist] / width, p[growth] * p[growth] * p[focus] / width, p[growth] * p[focus] * p[focus] / width});
  beam.axis_fwhm_mm.value = width;
  return beam;
}

}  // namespace vam::metrology
